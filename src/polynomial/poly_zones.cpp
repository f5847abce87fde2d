// SPDX-License-Identifier: Apache-2.0
#include "polynomial/poly_zones.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "polynomial/chebyshev_basis.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr std::size_t kMaxRims = 128, kMaxBounds = 256;

// Whole numbers as signed LEB128, seven bits a byte, the lowest first: small ones take one byte.
void add_leb128(std::string& to, std::int64_t value) {
  for (;;) {
    const auto bits = static_cast<unsigned char>(value & 0x7f);
    value >>= 7;
    const bool last = (value == 0 && (bits & 0x40) == 0) || (value == -1 && (bits & 0x40) != 0);
    to.push_back(static_cast<char>(last ? bits : bits | 0x80));
    if (last) return;
  }
}

// The next number; none at the end, or where it has more than 35 bits.
std::optional<std::int64_t> next_leb128(std::string_view& from) {
  std::int64_t value = 0;
  for (unsigned shift = 0; shift < 35 && !from.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(from.front());
    from.remove_prefix(1);
    value |= static_cast<std::int64_t>(byte & 0x7fU) << shift;
    if ((byte & 0x80U) != 0) continue;
    if ((byte & 0x40U) != 0) value |= -(std::int64_t{1} << (shift + 7));
    return value;
  }
  return std::nullopt;
}

CborNode node_of(const ChebyshevVector& vector) {
  return cbor_list({sum_node(vector.along_field), sum_node(vector.along_pupil)});
}

CborNode node_of(std::span<const PolynomialBounds> bounds) {
  std::vector<float> values;
  for (const PolynomialBounds& b : bounds) values.insert(values.end(), {b.field, b.low_x_mm, b.high_x_mm, b.half_y_mm});
  return floats_node(values);
}

constexpr std::array<std::string_view, 3> kStates{"fitted", "traced", "dark"};  // in the order of the enumeration

ChebyshevSum read_symmetric_sum(PolyReader& read, const CborNode* node) {
  return read_sum(read, node, kMaxDegree, term_count);
}

ChebyshevVector read_vector(PolyReader& read, const CborNode* node) {
  const auto parts = read.list(node, "a vector", 2, 2);
  if (read.failed()) return {};
  ChebyshevVector vector{read_symmetric_sum(read, &parts[0]), read_symmetric_sum(read, &parts[1])};
  if (vector.along_field.degree != vector.along_pupil.degree) read.fail("the parts of a vector differ in degree");
  return vector;
}

std::vector<PolynomialBounds> read_bounds(PolyReader& read, const CborNode* node, const PolynomialZone& zone) {
  const std::vector<float> values = read_floats(read, node, "the bounds of a pupil", 2 * 4, kMaxBounds * 4);
  std::vector<PolynomialBounds> bounds;
  if (values.size() % 4 != 0) read.fail("the bounds of a pupil have a wrong length");
  float before = 0.0F;
  for (std::size_t at = 0; at + 4 <= values.size() && !read.failed(); at += 4) {
    if (values[at] < before || static_cast<double>(values[at]) > 1.001 * zone.field_high + 1e-6)
      read.fail("the bounds of a pupil do not rise");
    before = values[at];
    bounds.push_back({values[at], values[at + 1], values[at + 2], values[at + 3]});
  }
  return bounds;
}

void read_polynomials_of(PolyReader& read, const CborNode& node, PolynomialZone& zone) {
  zone.order = read.whole(node.find("order"), "an order", 1, 2 * kMaxDegree + 1);
  const auto pupil = read.list(node.find("pupil"), "the pupil coordinates", 3, 4);
  if (read.failed()) return;
  zone.centre_mm = read.number(&pupil[0], "the pupil's centre", -1e6, 1e6);
  zone.centre_slope_mm = read.number(&pupil[1], "the pupil's centre", -1e6, 1e6);
  zone.radius_mm = read.number(&pupil[2], "the pupil's radius", 1e-9, 1e6);
  if (pupil.size() > 3) zone.pupil_end = read.number(&pupil[3], "the pupil's end", 1e-6, 1e6);
  zone.bounds = read_bounds(read, node.find("bounds"), zone);
  zone.sensor_mm = read_vector(read, node.find("sensor"));
  for (const CborNode& crossing : read.list(node.find("stop"), "the stop", 0, kMaxStopCrossings)) {
    zone.stop.push_back(read_vector(read, &crossing));
    if (read.failed()) return;
  }
  zone.rims = read_rims(read, node.find("rims"));
  if (read.failed()) return;
  zone.transmittance = read_symmetric_sum(read, node.find("transmittance"));
}

}  // namespace

CborNode sum_node(const ChebyshevSum& sum) {
  std::string bytes;
  for (const float c : sum.coefficients) add_leb128(bytes, std::llround(static_cast<double>(c) / sum.step));
  return cbor_list({cbor_number(sum.degree), cbor_number(sum.wavelength_terms), cbor_number(std::ilogb(sum.step)),
                    cbor_bytes(std::move(bytes))});
}

CborNode accuracy_node(const PolynomialAccuracy& accuracy) {
  return cbor_list({cbor_number(accuracy.position_p50_px), cbor_number(accuracy.position_p95_px),
                    cbor_number(accuracy.position_max_px), cbor_number(accuracy.edge_p95),
                    cbor_number(accuracy.transmittance_p95), cbor_number(accuracy.rays)});
}

ChebyshevSum read_sum(PolyReader& read, const CborNode* node, int max_degree,
                      const std::function<int(int)>& count_of_terms) {
  const auto parts = read.list(node, "a polynomial", 4, 4);
  if (read.failed()) return {};
  ChebyshevSum sum;
  sum.degree = read.whole(&parts[0], "a degree", 0, max_degree);
  sum.wavelength_terms = read.whole(&parts[1], "the number of wavelength terms", 1, kMaxWavelengthTerms);
  sum.step = static_cast<float>(std::ldexp(1.0, read.whole(&parts[2], "a step", -100, 60)));
  std::string_view rest = read.bytes(&parts[3], "coefficients");
  if (read.failed()) return {};
  const int count = count_of_terms(sum.degree) * sum.wavelength_terms;
  for (int k = 0; k < count; ++k) {
    const auto value = next_leb128(rest);
    if (!value || std::abs(*value) > (std::int64_t{1} << 24)) {
      read.fail("a polynomial has too few coefficients, or one that is too large");
      return {};
    }
    sum.coefficients.push_back(static_cast<float>(*value) * sum.step);
  }
  if (!rest.empty()) read.fail("a polynomial has too many coefficients");
  return sum;
}

PolynomialAccuracy read_accuracy(PolyReader& read, const CborNode* node) {
  const auto parts = read.list(node, "an accuracy", 6, 6);
  if (read.failed()) return {};
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const auto error = [&](std::size_t k) { return read.number(&parts[k], "an accuracy", 0.0, kAny); };
  return {error(0), error(1), error(2), error(3), error(4), read.whole(&parts[5], "a number of rays", 0, 1 << 30)};
}

CborNode floats_node(std::span<const float> values) {
  std::string bytes;
  for (const float value : values)
    for (unsigned shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<char>(std::bit_cast<std::uint32_t>(value) >> shift & 0xffU));
  return cbor_bytes(std::move(bytes));
}

std::vector<float> read_floats(PolyReader& read, const CborNode* node, const std::string& what, std::size_t low,
                               std::size_t high) {
  const std::string_view bytes = read.bytes(node, what);
  std::vector<float> values;
  if (read.failed()) return values;
  if (bytes.size() % 4 != 0 || bytes.size() < 4 * low || bytes.size() > 4 * high) {
    read.fail(what + " have a wrong length");
    return values;
  }
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 4; ++k)
      bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
    values.push_back(std::bit_cast<float>(bits));
    if (!(std::abs(values.back()) < 1e6F)) read.fail(what + " are out of range");
  }
  return values;
}

CborNode state_node(PolynomialZone::State state) {
  return cbor_text(std::string(kStates[static_cast<std::size_t>(state)]));
}

PolynomialZone::State read_state(PolyReader& read, const CborNode* node) {
  const std::string state = read.text(node, "the state of a zone");
  const auto found = std::ranges::find(kStates, state);
  if (found == kStates.end()) {
    read.fail(fmt::format("'{}' is no state of a zone", state));
    return PolynomialZone::State::Dark;
  }
  return static_cast<PolynomialZone::State>(found - kStates.begin());
}

CborNode zone_node(const PolynomialZone& zone) {
  CborNode node;
  node.add("state", state_node(zone.state));
  node.add("field", cbor_list({cbor_number(zone.field_low), cbor_number(zone.field_high)}));
  node.add("flux", cbor_number(zone.flux_mm2));
  node.add("accuracy", accuracy_node(zone.accuracy));
  if (zone.state != PolynomialZone::State::Fitted) return node;
  node.add("order", cbor_number(zone.order));
  CborNode pupil =
      cbor_list({cbor_number(zone.centre_mm), cbor_number(zone.centre_slope_mm), cbor_number(zone.radius_mm)});
  if (zone.pupil_end > 0.0) pupil.list.push_back(cbor_number(zone.pupil_end));
  node.add("pupil", std::move(pupil));
  node.add("bounds", node_of(zone.bounds));
  node.add("sensor", node_of(zone.sensor_mm));
  CborNode stop = cbor_list();
  for (const ChebyshevVector& crossing : zone.stop) stop.list.push_back(node_of(crossing));
  node.add("stop", std::move(stop));
  node.add("rims", rims_node(zone.rims));
  node.add("transmittance", sum_node(zone.transmittance));
  return node;
}

PolynomialZone read_zone(PolyReader& read, const CborNode& node) {
  PolynomialZone zone;
  zone.state = read_state(read, node.find("state"));
  const auto field = read.list(node.find("field"), "the field of a zone", 2, 2);
  if (read.failed()) return zone;
  zone.field_low = read.number(&field[0], "the field of a zone", 0.0, 100.0);
  zone.field_high = read.number(&field[1], "the field of a zone", 0.0, 100.0);
  if (!(zone.field_high > zone.field_low)) read.fail("a zone of the field is empty");
  zone.flux_mm2 = read.number(node.find("flux"), "the flux of a zone", 0.0, 1e12);
  zone.accuracy = read_accuracy(read, node.find("accuracy"));
  if (!read.failed() && zone.state == PolynomialZone::State::Fitted) read_polynomials_of(read, node, zone);
  return zone;
}

CborNode vector_node(const ChebyshevVector& vector) { return node_of(vector); }

CborNode rims_node(const std::vector<PolynomialRim>& rims) {
  CborNode node = cbor_list();
  for (const PolynomialRim& rim : rims) node.list.push_back(cbor_list({cbor_number(rim.step), sum_node(rim.squared)}));
  return node;
}

ChebyshevSum read_polynomial(PolyReader& read, const CborNode* node) { return read_symmetric_sum(read, node); }
ChebyshevVector read_polynomial_vector(PolyReader& read, const CborNode* node) { return read_vector(read, node); }

std::vector<PolynomialRim> read_rims(PolyReader& read, const CborNode* node) {
  std::vector<PolynomialRim> rims;
  for (const CborNode& rim : read.list(node, "the rims", 0, kMaxRims)) {
    const auto parts = read.list(&rim, "a rim", 2, 2);
    if (read.failed()) break;
    rims.push_back({read.whole(&parts[0], "a rim's step", 0, 10'000), read_symmetric_sum(read, &parts[1])});
    if (read.failed()) break;
  }
  return rims;
}

CborNode ghost_name_node(const Ghost& ghost) {
  CborNode name = cbor_list();
  for (const int part : {ghost.i, ghost.j, ghost.k, ghost.l, ghost.order[0], ghost.order[1]})
    name.list.push_back(cbor_number(part));
  return name;
}

Ghost read_ghost_name(PolyReader& read, const CborNode* node) {
  const auto name = read.list(node, "the surfaces of a ghost", 6, 6);
  if (read.failed()) return {};
  std::array<int, 6> parts{};
  for (std::size_t k = 0; k < parts.size(); ++k)
    parts[k] = read.whole(&name[k], "a surface of a ghost", k < 4 ? 0 : -1000, 10'000);
  return {parts[0], parts[1], parts[2], parts[3], {parts[4], parts[5]}};
}

}  // namespace contrejour::inline internal::polynomial
