// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/open_surfaces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Eigenvalues>

namespace contrejour::inline internal {
namespace {

constexpr double kLinked =
    0.08;  // elements of the projection onto open directions from which two unknowns belong together

using Group = std::vector<Eigen::Index>;

// Unknowns linked by the projection, directly or through others.
std::vector<Group> groups_of(const Eigen::MatrixXd& projection) {
  std::vector<Group> groups;
  std::vector<bool> taken(static_cast<std::size_t>(projection.rows()), false);
  for (Eigen::Index first = 0; first < projection.rows(); ++first) {
    if (taken[static_cast<std::size_t>(first)] || projection(first, first) < kLinked) continue;
    Group group{first};
    taken[static_cast<std::size_t>(first)] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (Eigen::Index other = 0; other < projection.rows(); ++other) {
        if (taken[static_cast<std::size_t>(other)] || std::abs(projection(group[k], other)) < kLinked) continue;
        taken[static_cast<std::size_t>(other)] = true;
        group.push_back(other);
      }
    }
    std::ranges::sort(group);
    groups.push_back(std::move(group));
  }
  return groups;
}

std::string text_of(const Group& group, const Eigen::MatrixXd& projection, std::span<const int> surfaces) {
  const auto number = [&](Eigen::Index k) { return surfaces[static_cast<std::size_t>(k)]; };
  if (group.size() == 1)
    return fmt::format("the ghosts do not determine the reflectance of surface {}", number(group.front()));
  const Eigen::MatrixXd part = projection(group, group);
  std::vector<int> all, up, down;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(part);
  const Eigen::VectorXd main = solver.eigenvectors().col(part.rows() - 1);
  for (std::size_t k = 0; k < group.size(); ++k) {
    all.push_back(number(group[k]));
    (main[static_cast<Eigen::Index>(k)] * main[0] > 0.0 ? up : down).push_back(number(group[k]));
  }
  const long open = std::lround(part.trace());
  if (open == 1 && !down.empty())
    return fmt::format(
        "the ghosts cannot tell the reflectances of surfaces {} from those of {}: the first may be higher by any "
        "factor if the others are lower by the same",
        fmt::join(up, ", "), fmt::join(down, ", "));
  return fmt::format("the ghosts leave {} combination{} of the reflectances of surfaces {} open", std::max(open, 1L),
                     open > 1 ? "s" : "", fmt::join(all, ", "));
}

}  // namespace

std::vector<std::string> open_surface_texts(std::span<const OpenDirection> open, std::span<const int> surfaces) {
  const auto count = static_cast<Eigen::Index>(surfaces.size());
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(count, count);
  for (const OpenDirection& direction : open) projection += direction * direction.transpose();
  std::vector<std::string> texts;
  for (const Group& group : groups_of(projection)) texts.push_back(text_of(group, projection, surfaces));
  return texts;
}

}  // namespace contrejour::inline internal
