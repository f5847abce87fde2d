// SPDX-License-Identifier: Apache-2.0
// Files of polynomials, of one state of a lens or of a range of states: docs/formats/poly.md.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/cbor_tree.h"
#include "base/text_file.h"
#include "contrejour/expert/polynomial_range.h"
#include "polynomial/poly_zones.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kStateVersion = 1, kRangeVersion = 2, kAsymmetricVersion = 3;
constexpr std::string_view kFormat = "contrejour polynomials";
constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;
constexpr std::size_t kMaxGhosts = 100'000, kMaxZones = 64, kMaxSpans = 256, kMaxNodes = 32, kMaxSurfaces = 10'000;
constexpr std::string_view kRemedy = "make one with `contrejour polynomial fit`";
constexpr std::array<std::string_view, 2> kVariables{"zoom", "focus"};  // in the order of the enumeration

CborNode node_of(const GhostPolynomials& ghost) {
  CborNode node, zones = cbor_list();
  for (const PolynomialZone& zone : ghost.zones) zones.list.push_back(zone_node(zone));
  node.add("ghost", ghost_name_node(ghost.ghost));
  node.add("zones", std::move(zones));
  if (!ghost.asymmetric.empty()) add_asymmetric(node, ghost);
  return node;
}

CborNode node_of(const PolynomialSpan& span) {
  CborNode node, zones = cbor_list();
  for (const std::vector<PolynomialZone>& zone : span.zones) {
    CborNode nodes = cbor_list();
    for (const PolynomialZone& at_node : zone) nodes.list.push_back(zone_node(at_node));
    zones.list.push_back(std::move(nodes));
  }
  node.add("range", cbor_list({cbor_number(span.low), cbor_number(span.high)}));
  node.add("zones", std::move(zones));
  return node;
}

CborNode node_of(const GhostRange& ghost) {
  CborNode node, spans = cbor_list();
  for (const PolynomialSpan& span : ghost.spans) spans.list.push_back(node_of(span));
  node.add("ghost", ghost_name_node(ghost.ghost));
  node.add("spans", std::move(spans));
  return node;
}

CborNode node_of(const RangePositions& positions) {
  CborNode node, all = cbor_list();
  for (const std::vector<double>& state : positions.z_mm) {
    CborNode z_mm = cbor_list();
    for (const double z : state) z_mm.list.push_back(cbor_number(z));
    all.list.push_back(std::move(z_mm));
  }
  node.add("range", cbor_list({cbor_number(positions.low), cbor_number(positions.high)}));
  node.add("z_mm", std::move(all));
  return node;
}

// All values but the ghosts.
CborNode root_of(const LensPolynomials& polynomials, double version) {
  CborNode root;
  root.add("format", cbor_text(std::string(kFormat)));
  root.add("version", cbor_number(version));
  root.add("lens", cbor_text(polynomials.lens));
  root.add("fingerprint", cbor_text(fmt::format("{:016x}", polynomials.fingerprint)));
  root.add("entrance_z_mm", cbor_number(polynomials.entrance_z_mm));
  root.add("stop_radius_mm", cbor_number(polynomials.stop_radius_mm));
  root.add("pixel_mm", cbor_number(polynomials.pixel_mm));
  root.add("wavelengths_nm", cbor_list({cbor_number(polynomials.shortest_nm), cbor_number(polynomials.longest_nm)}));
  root.add("max_field", cbor_number(polynomials.max_field));
  return root;
}

LensPolynomials read_without_ghosts(PolyReader& read, const CborNode& root) {
  LensPolynomials out;
  out.lens = read.text(root.find("lens"), "the lens");
  const std::string fingerprint = read.text(root.find("fingerprint"), "the fingerprint");
  if (fingerprint.size() != 16 || fingerprint.find_first_not_of("0123456789abcdef") != std::string::npos)
    read.fail("the fingerprint is not of 16 hexadecimal digits");
  else
    out.fingerprint = std::stoull(fingerprint, nullptr, 16);
  out.entrance_z_mm = read.number(root.find("entrance_z_mm"), "the entrance plane", -1e6, 1e6);
  out.stop_radius_mm = read.number(root.find("stop_radius_mm"), "the stop's radius", 1e-9, 1e6);
  out.pixel_mm = read.number(root.find("pixel_mm"), "the size of a pixel", 1e-9, 1e6);
  const auto nm = read.list(root.find("wavelengths_nm"), "the wavelengths", 2, 2);
  if (!read.failed()) {
    out.shortest_nm = read.number(&nm[0], "the shortest wavelength", 100.0, 1e5);
    out.longest_nm = read.number(&nm[1], "the longest wavelength", 100.0, 1e5);
    if (!(out.longest_nm > out.shortest_nm)) read.fail("the range of wavelengths is empty");
  }
  out.max_field = read.number(root.find("max_field"), "the largest field", 0.0, 100.0);
  return out;
}

GhostPolynomials read_ghost(PolyReader& read, const CborNode& node, bool may_be_asymmetric) {
  GhostPolynomials ghost{read_ghost_name(read, node.find("ghost")), {}};
  if (read.failed()) return ghost;
  for (const CborNode& zone : read.list(node.find("zones"), "the zones of a ghost", 1, kMaxZones)) {
    ghost.zones.push_back(read_zone(read, zone));
    if (read.failed()) return ghost;
    if (ghost.zones.size() > 1 && ghost.zones.back().field_low != ghost.zones[ghost.zones.size() - 2].field_high)
      read.fail(fmt::format("the zones of ghost {} do not adjoin", ghost_name(ghost.ghost)));
  }
  if (may_be_asymmetric && node.find("asymmetric") != nullptr) read_asymmetric(read, node, ghost);
  return ghost;
}

// Sets low and high; after: the end of the part before, if any.
template <class Part>
void read_part(PolyReader& read, const CborNode& node, const Part* before, Part& part) {
  const auto ends = read.list(node.find("range"), "a part of the range", 2, 2);
  if (read.failed()) return;
  part.low = read.number(&ends[0], "a part of the range", -100.0, 100.0);
  part.high = read.number(&ends[1], "a part of the range", -100.0, 100.0);
  if (!(part.high > part.low)) read.fail("a part of the range is empty");
  if (before != nullptr && before->high != part.low) read.fail("the parts of the range do not adjoin");
}

bool have_one_shape(const ChebyshevVector& a, const ChebyshevVector& b) {
  return a.along_field.degree == b.along_field.degree && a.along_pupil.degree == b.along_pupil.degree;
}

// Zones between which polynomials are interpolated.
bool have_one_shape(const PolynomialZone& a, const PolynomialZone& b) {
  if (a.state != b.state || a.pupil_end != b.pupil_end || a.bounds.size() != b.bounds.size() ||
      a.stop.size() != b.stop.size() || a.rims.size() != b.rims.size() ||
      a.transmittance.degree != b.transmittance.degree || !have_one_shape(a.sensor_mm, b.sensor_mm))
    return false;
  for (std::size_t c = 0; c < a.stop.size(); ++c)
    if (!have_one_shape(a.stop[c], b.stop[c])) return false;
  for (std::size_t r = 0; r < a.rims.size(); ++r)
    if (a.rims[r].step != b.rims[r].step || a.rims[r].squared.degree != b.rims[r].squared.degree) return false;
  return true;
}

std::vector<PolynomialZone> read_zone_nodes(PolyReader& read, const CborNode& list) {
  std::vector<PolynomialZone> nodes;
  for (const CborNode& node : read.list(&list, "the nodes of a zone", 2, kMaxNodes)) {
    nodes.push_back(read_zone(read, node));
    if (read.failed()) return nodes;
    if (!have_one_shape(nodes.front(), nodes.back())) read.fail("the nodes of a zone differ in their polynomials");
  }
  return nodes;
}

PolynomialSpan read_span(PolyReader& read, const CborNode& node, const PolynomialSpan* before) {
  PolynomialSpan span;
  read_part(read, node, before, span);
  for (const CborNode& zone : read.list(node.find("zones"), "the zones of a ghost", 1, kMaxZones)) {
    if (read.failed()) return span;
    span.zones.push_back(read_zone_nodes(read, zone));
    if (span.zones.back().size() != span.zones.front().size()) read.fail("the zones of a ghost differ in their nodes");
  }
  return span;
}

GhostRange read_ghost_range(PolyReader& read, const CborNode& node) {
  GhostRange ghost{read_ghost_name(read, node.find("ghost")), {}};
  if (read.failed()) return ghost;
  for (const CborNode& span : read.list(node.find("spans"), "the spans of a ghost", 1, kMaxSpans)) {
    ghost.spans.push_back(read_span(read, span, ghost.spans.empty() ? nullptr : &ghost.spans.back()));
    if (read.failed()) return ghost;
  }
  return ghost;
}

RangePositions read_positions(PolyReader& read, const CborNode& node, const RangePositions* before) {
  RangePositions positions;
  read_part(read, node, before, positions);
  for (const CborNode& state : read.list(node.find("z_mm"), "the positions of surfaces", 2, kMaxNodes)) {
    std::vector<double>& z_mm = positions.z_mm.emplace_back();
    for (const CborNode& z : read.list(&state, "the positions of surfaces", 1, kMaxSurfaces))
      z_mm.push_back(read.number(&z, "the position of a surface", -1e6, 1e6));
    if (z_mm.size() != positions.z_mm.front().size()) read.fail("states of a range differ in their surfaces");
    if (read.failed()) return positions;
  }
  return positions;
}

LensPolynomials read_one_state(PolyReader& read, const CborNode& root, bool may_be_asymmetric) {
  LensPolynomials out = read_without_ghosts(read, root);
  for (const CborNode& ghost : read.list(root.find("ghosts"), "the ghosts", 0, kMaxGhosts)) {
    if (read.failed()) break;
    out.ghosts.push_back(read_ghost(read, ghost, may_be_asymmetric));
  }
  return out;
}

LensPolynomialRange read_range(PolyReader& read, const CborNode& root) {
  LensPolynomialRange out;
  out.common = read_without_ghosts(read, root);
  const std::string variable = read.text(root.find("variable"), "what varies");
  const auto found = std::ranges::find(kVariables, variable);
  if (found == kVariables.end()) read.fail(fmt::format("'{}' is not zoom or focus", variable));
  if (read.failed()) return out;
  out.variable = static_cast<PolynomialVariable>(found - kVariables.begin());
  const auto ends_mm = read.list(root.find("ends_mm"), "the ends of the range", 2, 2);
  if (read.failed()) return out;
  for (std::size_t k = 0; k < 2; ++k)
    out.ends_mm[k] = read.number(&ends_mm[k], "the ends of the range", 0.0, std::numeric_limits<double>::infinity());
  for (const CborNode& part : read.list(root.find("positions"), "the positions of surfaces", 1, kMaxSpans)) {
    out.positions.push_back(read_positions(read, part, out.positions.empty() ? nullptr : &out.positions.back()));
    if (read.failed()) return out;
  }
  for (const CborNode& ghost : read.list(root.find("ghosts"), "the ghosts", 0, kMaxGhosts)) {
    if (read.failed()) break;
    out.ghosts.push_back(read_ghost_range(read, ghost));
  }
  return out;
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

std::string write_polynomials(const LensPolynomials& polynomials) {
  const bool symmetric =
      std::ranges::all_of(polynomials.ghosts, [](const GhostPolynomials& ghost) { return ghost.asymmetric.empty(); });
  CborNode root = root_of(polynomials, symmetric ? kStateVersion : kAsymmetricVersion), ghosts = cbor_list();
  for (const GhostPolynomials& ghost : polynomials.ghosts) ghosts.list.push_back(node_of(ghost));
  root.add("ghosts", std::move(ghosts));
  return write_cbor(root);
}

std::string write_polynomial_range(const LensPolynomialRange& range) {
  CborNode root = root_of(range.common, kRangeVersion), positions = cbor_list(), ghosts = cbor_list();
  for (const RangePositions& part : range.positions) positions.list.push_back(node_of(part));
  for (const GhostRange& ghost : range.ghosts) ghosts.list.push_back(node_of(ghost));
  root.add("variable", cbor_text(std::string(kVariables[static_cast<std::size_t>(range.variable)])));
  root.add("ends_mm", cbor_list({cbor_number(range.ends_mm[0]), cbor_number(range.ends_mm[1])}));
  root.add("positions", std::move(positions));
  root.add("ghosts", std::move(ghosts));
  return write_cbor(root);
}

Result<AnyPolynomials> read_any_polynomials(std::string_view bytes, const std::string& file) {
  const auto root = parse_cbor(bytes, file);
  if (!root) return tl::unexpected(root.error());
  const CborNode* const format = root->find("format");
  if (format == nullptr || format->text != kFormat)
    return failure(ErrorCode::Parse, fmt::format("not a file of polynomials; {}", kRemedy), {file, 0, 0});
  const CborNode* const version = root->find("version");
  const bool is_range = version != nullptr && version->number == kRangeVersion;
  const bool may_be_asymmetric = version != nullptr && version->number == kAsymmetricVersion;
  if (!is_range && !may_be_asymmetric && (version == nullptr || version->number != kStateVersion))
    return failure(ErrorCode::Parse, "a version of the format that is not known; fit the lens again", {file, 0, 0});
  PolyReader read;
  AnyPolynomials out = is_range ? AnyPolynomials(read_range(read, *root))
                                : AnyPolynomials(read_one_state(read, *root, may_be_asymmetric));
  if (read.failed()) return failure(ErrorCode::Parse, *read.error(), {file, 0, 0});
  return out;
}

Result<AnyPolynomials> read_any_polynomial_file(const std::filesystem::path& file) {
  const auto bytes = read_text_file(file, kMaxBytes, std::string(kRemedy));
  if (!bytes) return tl::unexpected(bytes.error());
  return read_any_polynomials(*bytes, file.string());
}

Result<LensPolynomials> read_polynomials(std::string_view bytes, const std::string& file) {
  auto read = read_any_polynomials(bytes, file);
  if (!read) return tl::unexpected(read.error());
  if (auto* const state = std::get_if<LensPolynomials>(&*read)) return std::move(*state);
  return failure(ErrorCode::Parse,
                 "a fit of a range of zoom or focus; choose a state of it with `contrejour polynomial at`",
                 {file, 0, 0});
}

Result<LensPolynomials> read_polynomial_file(const std::filesystem::path& file) {
  const auto bytes = read_text_file(file, kMaxBytes, std::string(kRemedy));
  if (!bytes) return tl::unexpected(bytes.error());
  return read_polynomials(*bytes, file.string());
}

}  // namespace contrejour
