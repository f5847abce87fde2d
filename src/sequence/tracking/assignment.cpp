// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/assignment.h"

#include <cassert>

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

namespace contrejour::inline internal {
namespace {

using Graph = lemon::SmartDigraph;

std::vector<Graph::Node> add_nodes(Graph& graph, int count) {
  std::vector<Graph::Node> nodes;
  for (int k = 0; k < count; ++k) nodes.push_back(graph.addNode());
  return nodes;
}

}  // namespace

// As the circulation of least cost, whose arcs carry at most 1: from a hub to each row, along a pair at the cost of
// minus its gain, and from each column back to the hub. LEMON's network simplex finds it in whole numbers; its headers
// are all that is used of the library.
std::vector<int> best_assignment(int rows, int columns, std::span<const PairGain> pairs) {
  Graph graph;
  const Graph::Node hub = graph.addNode();
  const std::vector<Graph::Node> of_rows = add_nodes(graph, rows), of_columns = add_nodes(graph, columns);
  for (const Graph::Node row : of_rows) graph.addArc(hub, row);
  for (const Graph::Node column : of_columns) graph.addArc(column, hub);
  Graph::ArcMap<std::int64_t> cost(graph, 0);
  std::vector<Graph::Arc> arcs;
  for (const PairGain& pair : pairs) {
    arcs.push_back(
        graph.addArc(of_rows[static_cast<std::size_t>(pair.row)], of_columns[static_cast<std::size_t>(pair.column)]));
    cost[arcs.back()] = -pair.gain;
  }
  std::vector<int> column_of_row(static_cast<std::size_t>(rows), -1);
  if (pairs.empty()) return column_of_row;
  const Graph::ArcMap<int> most(graph, 1);
  lemon::NetworkSimplex<Graph, int, std::int64_t> simplex(graph);
  [[maybe_unused]] const auto outcome = simplex.upperMap(most).costMap(cost).run();
  assert(outcome == decltype(simplex)::OPTIMAL);  // no flow at all is a circulation, and all arcs are bounded
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (simplex.flow(arcs[k]) > 0) column_of_row[static_cast<std::size_t>(pairs[k].row)] = pairs[k].column;
  return column_of_row;
}

}  // namespace contrejour::inline internal
