// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "polynomial/asymmetric_basis.h"
#include "polynomial/chebyshev_basis.h"
#include "polynomial/poly_zones.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr std::size_t kMaxAsymmetricZones = 64, kMaxAsymmetricRims = 128;
constexpr int kMaxBoundsSide = 65;
constexpr double kFarthest_mm = 1e6, kLargestTangent = 100.0, kSmallestZone = 1e-9;

CborNode numbers_node(std::span<const double> values) {
  CborNode node = cbor_list();
  for (const double value : values) node.list.push_back(cbor_number(value));
  return node;
}

CborNode vector_node(const AsymmetricVector& vector) { return cbor_list({sum_node(vector.x), sum_node(vector.y)}); }

CborNode asymmetric_node(const AsymmetricZone& zone) {
  CborNode node;
  node.add("state", state_node(zone.state));
  node.add("field", numbers_node(std::array{zone.low.x, zone.low.y, zone.high.x, zone.high.y}));
  node.add("even", numbers_node(std::array{zone.even_x ? 1.0 : 0.0, zone.even_y ? 1.0 : 0.0}));
  node.add("flux", cbor_number(zone.flux_mm2));
  node.add("accuracy", accuracy_node(zone.accuracy));
  if (zone.state != PolynomialZone::State::Fitted) return node;
  node.add("order", cbor_number(zone.order));
  node.add("centre_x", numbers_node(zone.centre_x_mm));
  node.add("centre_y", numbers_node(zone.centre_y_mm));
  node.add("radius", numbers_node(std::array{zone.radius_mm.x, zone.radius_mm.y}));
  std::vector<float> bounds;
  for (const AsymmetricBounds& b : zone.bounds)
    bounds.insert(bounds.end(), {b.low_x_mm, b.low_y_mm, b.high_x_mm, b.high_y_mm});
  node.add("bounds_side", cbor_number(zone.bounds_side));
  node.add("bounds", floats_node(bounds));
  node.add("sensor", vector_node(zone.sensor_mm));
  CborNode stop = cbor_list(), rims = cbor_list();
  for (const AsymmetricVector& crossing : zone.stop) stop.list.push_back(vector_node(crossing));
  for (const PolynomialRim& rim : zone.rims)
    rims.list.push_back(cbor_list({cbor_number(rim.step), sum_node(rim.squared)}));
  node.add("stop", std::move(stop));
  node.add("rims", std::move(rims));
  node.add("transmittance", sum_node(zone.transmittance));
  return node;
}

template <std::size_t kCount>
std::array<double, kCount> read_numbers(PolyReader& read, const CborNode* node, std::string_view what, double low,
                                        double high) {
  std::array<double, kCount> values{};
  const auto parts = read.list(node, what, kCount, kCount);
  if (read.failed()) return values;
  for (std::size_t k = 0; k < kCount; ++k) values[k] = read.number(&parts[k], what, low, high);
  return values;
}

ChebyshevSum read_asymmetric_sum(PolyReader& read, const CborNode* node, const Parities& parities) {
  return read_sum(read, node, kMaxAsymmetricDegree,
                  [&](int degree) { return asymmetric_term_count(degree, parities); });
}

AsymmetricVector read_asymmetric_vector(PolyReader& read, const CborNode* node, const AsymmetricZone& zone) {
  const auto parts = read.list(node, "a vector", 2, 2);
  if (read.failed()) return {};
  return {read_asymmetric_sum(read, &parts[0], parities_of_x(zone)),
          read_asymmetric_sum(read, &parts[1], parities_of_y(zone))};
}

void read_coordinates(PolyReader& read, const CborNode& node, AsymmetricZone& zone) {
  zone.order = read.whole(node.find("order"), "an order", 1, kMaxAsymmetricDegree);
  zone.centre_x_mm = read_numbers<10>(read, node.find("centre_x"), "the pupil's centre", -kFarthest_mm, kFarthest_mm);
  zone.centre_y_mm = read_numbers<10>(read, node.find("centre_y"), "the pupil's centre", -kFarthest_mm, kFarthest_mm);
  const auto radius = read_numbers<2>(read, node.find("radius"), "the pupil's radius", 1e-9, kFarthest_mm);
  zone.radius_mm = {radius[0], radius[1]};
  zone.bounds_side = read.whole(node.find("bounds_side"), "the side of the bounds", 2, kMaxBoundsSide);
  const std::size_t count = 4 * static_cast<std::size_t>(zone.bounds_side * zone.bounds_side);
  const std::vector<float> bounds = read_floats(read, node.find("bounds"), "the bounds of a pupil", count, count);
  for (std::size_t at = 0; at + 4 <= bounds.size(); at += 4)
    zone.bounds.push_back({bounds[at], bounds[at + 1], bounds[at + 2], bounds[at + 3]});
}

void read_outputs(PolyReader& read, const CborNode& node, AsymmetricZone& zone) {
  zone.sensor_mm = read_asymmetric_vector(read, node.find("sensor"), zone);
  for (const CborNode& crossing : read.list(node.find("stop"), "the stop", 0, kMaxStopCrossings)) {
    zone.stop.push_back(read_asymmetric_vector(read, &crossing, zone));
    if (read.failed()) return;
  }
  for (const CborNode& rim : read.list(node.find("rims"), "the rims", 0, kMaxAsymmetricRims)) {
    const auto parts = read.list(&rim, "a rim", 2, 2);
    if (read.failed()) return;
    zone.rims.push_back({read.whole(&parts[0], "a rim's step", 0, 10'000),
                         read_asymmetric_sum(read, &parts[1], parities_of_scalar(zone))});
    if (read.failed()) return;
  }
  zone.transmittance = read_asymmetric_sum(read, node.find("transmittance"), parities_of_scalar(zone));
}

AsymmetricZone read_asymmetric_zone(PolyReader& read, const CborNode& node, const GhostPolynomials& ghost) {
  AsymmetricZone zone;
  zone.state = read_state(read, node.find("state"));
  const auto field =
      read_numbers<4>(read, node.find("field"), "the field of a zone", -kLargestTangent, kLargestTangent);
  const auto even = read_numbers<2>(read, node.find("even"), "the symmetry of a zone", 0.0, 1.0);
  zone.low = {field[0], field[1]};
  zone.high = {field[2], field[3]};
  zone.even_x = even[0] != 0.0;
  zone.even_y = even[1] != 0.0;
  if (!(zone.high.x - zone.low.x > kSmallestZone && zone.high.y - zone.low.y > kSmallestZone))
    read.fail("a zone of the field is empty");
  if ((zone.even_x && (!ghost.mirror_x || zone.low.x != -zone.high.x)) ||
      (zone.even_y && (!ghost.mirror_y || zone.low.y != -zone.high.y)))
    read.fail("a zone of the field is not symmetric");
  zone.flux_mm2 = read.number(node.find("flux"), "the flux of a zone", 0.0, 1e12);
  zone.accuracy = read_accuracy(read, node.find("accuracy"));
  if (read.failed() || zone.state != PolynomialZone::State::Fitted) return zone;
  read_coordinates(read, node, zone);
  if (!read.failed()) read_outputs(read, node, zone);
  return zone;
}

}  // namespace

void add_asymmetric(CborNode& node, const GhostPolynomials& ghost) {
  CborNode zones = cbor_list();
  for (const AsymmetricZone& zone : ghost.asymmetric) zones.list.push_back(asymmetric_node(zone));
  node.add("mirrors", numbers_node(std::array{ghost.mirror_x ? 1.0 : 0.0, ghost.mirror_y ? 1.0 : 0.0}));
  node.add("asymmetric", std::move(zones));
}

void read_asymmetric(PolyReader& read, const CborNode& node, GhostPolynomials& ghost) {
  const auto mirrors = read_numbers<2>(read, node.find("mirrors"), "the mirror planes", 0.0, 1.0);
  ghost.mirror_x = mirrors[0] != 0.0;
  ghost.mirror_y = mirrors[1] != 0.0;
  for (const CborNode& zone : read.list(node.find("asymmetric"), "the zones of a ghost", 1, kMaxAsymmetricZones)) {
    if (read.failed()) return;
    ghost.asymmetric.push_back(read_asymmetric_zone(read, zone, ghost));
  }
}

}  // namespace contrejour::inline internal::polynomial
