// SPDX-License-Identifier: Apache-2.0
// Zones of polynomials in CBOR, and a reader of values that may be wrong: docs/formats/poly.md.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/cbor_tree.h"
#include "contrejour/expert/polynomial.h"

namespace contrejour::inline internal::polynomial {

// Reads values, and remembers the first that is wrong.
class PolyReader {
 public:
  [[nodiscard]] const std::optional<std::string>& error() const { return error_; }

  double number(const CborNode* node, std::string_view what, double low, double high) {
    if (node != nullptr && node->kind == CborNode::Kind::Number && node->number >= low && node->number <= high)
      return node->number;
    fail(fmt::format("{} is missing or out of range", what));
    return low;
  }
  int whole(const CborNode* node, std::string_view what, int low, int high) {
    const double value = number(node, what, low, high);
    if (value != std::floor(value)) fail(fmt::format("{} is not a whole number", what));
    return static_cast<int>(value);
  }
  std::string text(const CborNode* node, std::string_view what) {
    if (node != nullptr && node->kind == CborNode::Kind::Text) return node->text;
    fail(fmt::format("{} is missing", what));
    return {};
  }
  std::string_view bytes(const CborNode* node, std::string_view what) {
    if (node != nullptr && node->kind == CborNode::Kind::Bytes) return node->text;
    fail(fmt::format("{} is missing", what));
    return {};
  }
  std::span<const CborNode> list(const CborNode* node, std::string_view what, std::size_t low, std::size_t high) {
    if (node != nullptr && node->kind == CborNode::Kind::List && node->list.size() >= low && node->list.size() <= high)
      return node->list;
    fail(fmt::format("{} is missing or has a wrong length", what));
    return {};
  }
  void fail(std::string message) {
    if (!error_) error_ = std::move(message);
  }
  [[nodiscard]] bool failed() const { return error_.has_value(); }

 private:
  std::optional<std::string> error_;
};

// Parts of zones of either kind. count_of_terms: by degree.
[[nodiscard]] CborNode sum_node(const ChebyshevSum& sum);
[[nodiscard]] ChebyshevSum read_sum(PolyReader& read, const CborNode* node, int max_degree,
                                    const std::function<int(int)>& count_of_terms);
[[nodiscard]] CborNode accuracy_node(const PolynomialAccuracy& accuracy);
[[nodiscard]] PolynomialAccuracy read_accuracy(PolyReader& read, const CborNode* node);
[[nodiscard]] CborNode state_node(PolynomialZone::State state);
[[nodiscard]] PolynomialZone::State read_state(PolyReader& read, const CborNode* node);
// Little-endian floats, low to high of them, below 1e6. what: in the plural.
[[nodiscard]] CborNode floats_node(std::span<const float> values);
[[nodiscard]] std::vector<float> read_floats(PolyReader& read, const CborNode* node, const std::string& what,
                                             std::size_t low, std::size_t high);

// Adds `mirrors` and `asymmetric` to the node of a ghost without axial symmetry, and reads them.
void add_asymmetric(CborNode& node, const GhostPolynomials& ghost);
void read_asymmetric(PolyReader& read, const CborNode& node, GhostPolynomials& ghost);

[[nodiscard]] CborNode zone_node(const PolynomialZone& zone);
[[nodiscard]] PolynomialZone read_zone(PolyReader& read, const CborNode& node);

// A polynomial and a vector of the basis with axial symmetry alone, and the squared heights at rims.
[[nodiscard]] CborNode vector_node(const ChebyshevVector& vector);
[[nodiscard]] CborNode rims_node(const std::vector<PolynomialRim>& rims);
[[nodiscard]] ChebyshevSum read_polynomial(PolyReader& read, const CborNode* node);
[[nodiscard]] ChebyshevVector read_polynomial_vector(PolyReader& read, const CborNode* node);
[[nodiscard]] std::vector<PolynomialRim> read_rims(PolyReader& read, const CborNode* node);

// [i, j, k, l, order x, order y].
[[nodiscard]] CborNode ghost_name_node(const Ghost& ghost);
[[nodiscard]] Ghost read_ghost_name(PolyReader& read, const CborNode* node);

}  // namespace contrejour::inline internal::polynomial
