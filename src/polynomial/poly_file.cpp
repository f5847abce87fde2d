// SPDX-License-Identifier: Apache-2.0
// Files of polynomials: docs/formats/poly.md.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "base/cbor_tree.h"
#include "base/text_file.h"
#include "polynomial/chebyshev_basis.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kVersion = 1;
constexpr std::string_view kFormat = "contrejour polynomials";
constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
constexpr std::size_t kMaxGhosts = 100'000, kMaxZones = 64, kMaxRims = 128, kMaxBounds = 256;

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

CborNode node_of(const ChebyshevSum& sum) {
  std::string bytes;
  for (const float c : sum.coefficients) add_leb128(bytes, std::llround(static_cast<double>(c) / sum.step));
  return cbor_list({cbor_number(sum.degree), cbor_number(sum.wavelength_terms), cbor_number(std::ilogb(sum.step)),
                    cbor_bytes(std::move(bytes))});
}

CborNode node_of(const ChebyshevVector& vector) {
  return cbor_list({node_of(vector.along_field), node_of(vector.along_pupil)});
}

CborNode node_of(const PolynomialAccuracy& accuracy) {
  return cbor_list({cbor_number(accuracy.position_p50_px), cbor_number(accuracy.position_p95_px),
                    cbor_number(accuracy.position_max_px), cbor_number(accuracy.edge_p95),
                    cbor_number(accuracy.transmittance_p95), cbor_number(accuracy.rays)});
}

// Little-endian floats.
CborNode node_of(std::span<const PolynomialBounds> bounds) {
  std::string bytes;
  for (const PolynomialBounds& b : bounds)
    for (const float value : {b.field, b.low_x_mm, b.high_x_mm, b.half_y_mm})
      for (unsigned shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<char>(std::bit_cast<std::uint32_t>(value) >> shift & 0xffU));
  return cbor_bytes(std::move(bytes));
}

constexpr std::array<std::string_view, 3> kStates{"fitted", "traced", "dark"};  // in the order of the enumeration

CborNode node_of(const PolynomialZone& zone) {
  CborNode node;
  node.add("state", cbor_text(std::string(kStates[static_cast<std::size_t>(zone.state)])));
  node.add("field", cbor_list({cbor_number(zone.field_low), cbor_number(zone.field_high)}));
  node.add("flux", cbor_number(zone.flux_mm2));
  node.add("accuracy", node_of(zone.accuracy));
  if (zone.state != PolynomialZone::State::Fitted) return node;
  node.add("order", cbor_number(zone.order));
  node.add("pupil",
           cbor_list({cbor_number(zone.centre_mm), cbor_number(zone.centre_slope_mm), cbor_number(zone.radius_mm)}));
  node.add("bounds", node_of(zone.bounds));
  node.add("sensor", node_of(zone.sensor_mm));
  CborNode stop = cbor_list(), rims = cbor_list();
  for (const ChebyshevVector& crossing : zone.stop) stop.list.push_back(node_of(crossing));
  for (const PolynomialRim& rim : zone.rims)
    rims.list.push_back(cbor_list({cbor_number(rim.step), node_of(rim.squared)}));
  node.add("stop", std::move(stop));
  node.add("rims", std::move(rims));
  node.add("transmittance", node_of(zone.transmittance));
  return node;
}

CborNode node_of(const GhostPolynomials& ghost) {
  const Ghost& g = ghost.ghost;
  CborNode node, name = cbor_list(), zones = cbor_list();
  for (const int part : {g.i, g.j, g.k, g.l, g.order[0], g.order[1]}) name.list.push_back(cbor_number(part));
  for (const PolynomialZone& zone : ghost.zones) zones.list.push_back(node_of(zone));
  node.add("ghost", std::move(name));
  node.add("zones", std::move(zones));
  return node;
}

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

ChebyshevSum read_sum(PolyReader& read, const CborNode* node) {
  const auto parts = read.list(node, "a polynomial", 4, 4);
  if (read.failed()) return {};
  ChebyshevSum sum;
  sum.degree = read.whole(&parts[0], "a degree", 0, kMaxDegree);
  sum.wavelength_terms = read.whole(&parts[1], "the number of wavelength terms", 1, kMaxWavelengthTerms);
  sum.step = static_cast<float>(std::ldexp(1.0, read.whole(&parts[2], "a step", -100, 60)));
  std::string_view rest = read.bytes(&parts[3], "coefficients");
  if (read.failed()) return {};
  const int count = term_count(sum.degree) * sum.wavelength_terms;
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

ChebyshevVector read_vector(PolyReader& read, const CborNode* node) {
  const auto parts = read.list(node, "a vector", 2, 2);
  if (read.failed()) return {};
  ChebyshevVector vector{read_sum(read, &parts[0]), read_sum(read, &parts[1])};
  if (vector.along_field.degree != vector.along_pupil.degree) read.fail("the parts of a vector differ in degree");
  return vector;
}

PolynomialAccuracy read_accuracy(PolyReader& read, const CborNode* node) {
  const auto parts = read.list(node, "an accuracy", 6, 6);
  if (read.failed()) return {};
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const auto error = [&](std::size_t k) { return read.number(&parts[k], "an accuracy", 0.0, kAny); };
  return {error(0), error(1), error(2), error(3), error(4), read.whole(&parts[5], "a number of rays", 0, 1 << 30)};
}

std::vector<PolynomialBounds> read_bounds(PolyReader& read, const CborNode* node, const PolynomialZone& zone) {
  const std::string_view bytes = read.bytes(node, "the bounds of a pupil");
  std::vector<PolynomialBounds> bounds;
  if (read.failed()) return bounds;
  if (bytes.size() % 16 != 0 || bytes.size() < 32 || bytes.size() > 16 * kMaxBounds)
    read.fail("the bounds of a pupil have a wrong length");
  float before = 0.0F;
  for (std::size_t at = 0; at + 16 <= bytes.size() && !read.failed(); at += 16) {
    std::array<float, 4> values{};
    for (std::size_t k = 0; k < 16; ++k) {
      auto bits = std::bit_cast<std::uint32_t>(values[k / 4]);
      bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * (k % 4));
      values[k / 4] = std::bit_cast<float>(bits);
    }
    for (const float value : values)
      if (!(std::abs(value) < 1e6F)) read.fail("the bounds of a pupil are out of range");
    if (values[0] < before || static_cast<double>(values[0]) > 1.001 * zone.field_high + 1e-6)
      read.fail("the bounds of a pupil do not rise");
    before = values[0];
    bounds.push_back({values[0], values[1], values[2], values[3]});
  }
  return bounds;
}

void read_polynomials_of(PolyReader& read, const CborNode& node, PolynomialZone& zone) {
  zone.order = read.whole(node.find("order"), "an order", 1, 2 * kMaxDegree + 1);
  const auto pupil = read.list(node.find("pupil"), "the pupil coordinates", 3, 3);
  if (read.failed()) return;
  zone.centre_mm = read.number(&pupil[0], "the pupil's centre", -1e6, 1e6);
  zone.centre_slope_mm = read.number(&pupil[1], "the pupil's centre", -1e6, 1e6);
  zone.radius_mm = read.number(&pupil[2], "the pupil's radius", 1e-9, 1e6);
  zone.bounds = read_bounds(read, node.find("bounds"), zone);
  zone.sensor_mm = read_vector(read, node.find("sensor"));
  for (const CborNode& crossing : read.list(node.find("stop"), "the stop", 0, kMaxStopCrossings)) {
    zone.stop.push_back(read_vector(read, &crossing));
    if (read.failed()) return;
  }
  for (const CborNode& rim : read.list(node.find("rims"), "the rims", 0, kMaxRims)) {
    const auto parts = read.list(&rim, "a rim", 2, 2);
    if (read.failed()) return;
    zone.rims.push_back({read.whole(&parts[0], "a rim's step", 0, 10'000), read_sum(read, &parts[1])});
    if (read.failed()) return;
  }
  zone.transmittance = read_sum(read, node.find("transmittance"));
}

PolynomialZone read_zone(PolyReader& read, const CborNode& node) {
  PolynomialZone zone;
  const std::string state = read.text(node.find("state"), "the state of a zone");
  const auto found = std::ranges::find(kStates, state);
  const auto field = read.list(node.find("field"), "the field of a zone", 2, 2);
  if (found == kStates.end()) read.fail(fmt::format("'{}' is no state of a zone", state));
  if (read.failed()) return zone;
  zone.state = static_cast<PolynomialZone::State>(found - kStates.begin());
  zone.field_low = read.number(&field[0], "the field of a zone", 0.0, 100.0);
  zone.field_high = read.number(&field[1], "the field of a zone", 0.0, 100.0);
  if (!(zone.field_high > zone.field_low)) read.fail("a zone of the field is empty");
  zone.flux_mm2 = read.number(node.find("flux"), "the flux of a zone", 0.0, 1e12);
  zone.accuracy = read_accuracy(read, node.find("accuracy"));
  if (!read.failed() && zone.state == PolynomialZone::State::Fitted) read_polynomials_of(read, node, zone);
  return zone;
}

GhostPolynomials read_ghost(PolyReader& read, const CborNode& node) {
  GhostPolynomials ghost;
  const auto name = read.list(node.find("ghost"), "the surfaces of a ghost", 6, 6);
  if (read.failed()) return ghost;
  std::array<int, 6> parts{};
  for (std::size_t k = 0; k < parts.size(); ++k)
    parts[k] = read.whole(&name[k], "a surface of a ghost", k < 4 ? 0 : -1000, 10'000);
  ghost.ghost = {parts[0], parts[1], parts[2], parts[3], {parts[4], parts[5]}};
  for (const CborNode& zone : read.list(node.find("zones"), "the zones of a ghost", 1, kMaxZones)) {
    ghost.zones.push_back(read_zone(read, zone));
    if (read.failed()) return ghost;
    if (ghost.zones.size() > 1 && ghost.zones.back().field_low != ghost.zones[ghost.zones.size() - 2].field_high)
      read.fail(fmt::format("the zones of ghost {} do not adjoin", ghost_name(ghost.ghost)));
  }
  return ghost;
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

std::string write_polynomials(const LensPolynomials& polynomials) {
  CborNode root, ghosts = cbor_list();
  root.add("format", cbor_text(std::string(kFormat)));
  root.add("version", cbor_number(kVersion));
  root.add("lens", cbor_text(polynomials.lens));
  root.add("fingerprint", cbor_text(fmt::format("{:016x}", polynomials.fingerprint)));
  root.add("entrance_z_mm", cbor_number(polynomials.entrance_z_mm));
  root.add("stop_radius_mm", cbor_number(polynomials.stop_radius_mm));
  root.add("pixel_mm", cbor_number(polynomials.pixel_mm));
  root.add("wavelengths_nm", cbor_list({cbor_number(polynomials.shortest_nm), cbor_number(polynomials.longest_nm)}));
  root.add("max_field", cbor_number(polynomials.max_field));
  for (const GhostPolynomials& ghost : polynomials.ghosts) ghosts.list.push_back(node_of(ghost));
  root.add("ghosts", std::move(ghosts));
  return write_cbor(root);
}

Result<LensPolynomials> read_polynomials(std::string_view bytes, const std::string& file) {
  const auto root = parse_cbor(bytes, file);
  if (!root) return tl::unexpected(root.error());
  PolyReader read;
  const CborNode* const format = root->find("format");
  if (format == nullptr || format->text != kFormat)
    return failure(ErrorCode::Parse, "not a file of polynomials; make one with `contrejour polynomial fit`",
                   {file, 0, 0});
  const CborNode* const version = root->find("version");
  if (version == nullptr || version->number != kVersion)
    return failure(ErrorCode::Parse, "a version of the format that is not known; fit the lens again", {file, 0, 0});
  LensPolynomials out;
  out.lens = read.text(root->find("lens"), "the lens");
  const std::string fingerprint = read.text(root->find("fingerprint"), "the fingerprint");
  if (fingerprint.size() != 16 || fingerprint.find_first_not_of("0123456789abcdef") != std::string::npos)
    read.fail("the fingerprint is not of 16 hexadecimal digits");
  else
    out.fingerprint = std::stoull(fingerprint, nullptr, 16);
  out.entrance_z_mm = read.number(root->find("entrance_z_mm"), "the entrance plane", -1e6, 1e6);
  out.stop_radius_mm = read.number(root->find("stop_radius_mm"), "the stop's radius", 1e-9, 1e6);
  out.pixel_mm = read.number(root->find("pixel_mm"), "the size of a pixel", 1e-9, 1e6);
  const auto nm = read.list(root->find("wavelengths_nm"), "the wavelengths", 2, 2);
  if (!read.failed()) {
    out.shortest_nm = read.number(&nm[0], "the shortest wavelength", 100.0, 1e5);
    out.longest_nm = read.number(&nm[1], "the longest wavelength", 100.0, 1e5);
    if (!(out.longest_nm > out.shortest_nm)) read.fail("the range of wavelengths is empty");
  }
  out.max_field = read.number(root->find("max_field"), "the largest field", 0.0, 100.0);
  for (const CborNode& ghost : read.list(root->find("ghosts"), "the ghosts", 0, kMaxGhosts)) {
    if (read.failed()) break;
    out.ghosts.push_back(read_ghost(read, ghost));
  }
  if (read.failed()) return failure(ErrorCode::Parse, *read.error(), {file, 0, 0});
  return out;
}

Result<LensPolynomials> read_polynomial_file(const std::filesystem::path& file) {
  const auto bytes = read_text_file(file, kMaxBytes, "make one with `contrejour polynomial fit`");
  if (!bytes) return tl::unexpected(bytes.error());
  return read_polynomials(*bytes, file.string());
}

}  // namespace contrejour
