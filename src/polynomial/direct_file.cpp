// SPDX-License-Identifier: Apache-2.0
// Files of the direct image's polynomials: docs/formats/poly.md, "The direct image".
#include <limits>

#include <fmt/format.h>

#include "base/cbor_tree.h"
#include "base/text_file.h"
#include "contrejour/expert/direct_polynomials.h"
#include "polynomial/poly_zones.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr std::string_view kDirectFormat = "contrejour direct polynomials";
constexpr double kDirectVersion = 1;
constexpr std::size_t kMaxDirectBytes = std::size_t{64} << 20U;
constexpr std::string_view kDirectRemedy = "make one with `contrejour polynomial fit --direct`";

CborNode node_of(const DirectAccuracy& accuracy) {
  CborNode node = cbor_list();
  for (const double value : {accuracy.sensor_p50_px, accuracy.sensor_p95_px, accuracy.sensor_max_px, accuracy.stop_p95,
                             accuracy.rim_p95, accuracy.transmittance_p95, accuracy.let_through, accuracy.blocked})
    node.list.push_back(cbor_number(value));
  node.list.push_back(cbor_number(accuracy.rays));
  return node;
}

DirectAccuracy read_direct_accuracy(PolyReader& read, const CborNode* node) {
  const auto parts = read.list(node, "the accuracy", 9, 9);
  if (read.failed()) return {};
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const auto error = [&](std::size_t k) { return read.number(&parts[k], "the accuracy", 0.0, kAny); };
  return {error(0), error(1), error(2),
          error(3), error(4), error(5),
          error(6), error(7), read.whole(&parts[8], "a number of rays", 0, 1 << 30)};
}

std::uint64_t read_fingerprint(PolyReader& read, const CborNode* node) {
  const std::string text = read.text(node, "the fingerprint");
  if (text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos)
    return std::stoull(text, nullptr, 16);
  read.fail("the fingerprint is not of 16 hexadecimal digits");
  return 0;
}

DirectPolynomials read_direct(PolyReader& read, const CborNode& root) {
  DirectPolynomials out;
  out.lens = read.text(root.find("lens"), "the lens");
  out.fingerprint = read_fingerprint(read, root.find("fingerprint"));
  const auto number = [&](const char* key, double low, double high) {
    return read.number(root.find(key), key, low, high);
  };
  out.focal_length_mm = number("focal_length_mm", -1e9, 1e9);
  out.front_z_mm = number("front_z_mm", -1e6, 1e6);
  out.sensor_z_mm = number("sensor_z_mm", -1e6, 1e6);
  out.stop_radius_mm = number("stop_radius_mm", 1e-9, 1e6);
  out.max_height_mm = number("max_height_mm", 1e-9, 1e6);
  out.pixel_mm = number("pixel_mm", 1e-9, 1e6);
  const auto nm = read.list(root.find("wavelengths_nm"), "the wavelengths", 2, 2);
  if (read.failed()) return out;
  out.shortest_nm = read.number(&nm[0], "the shortest wavelength", 100.0, 1e5);
  out.longest_nm = read.number(&nm[1], "the longest wavelength", 100.0, 1e5);
  if (!(out.longest_nm > out.shortest_nm)) read.fail("the range of wavelengths is empty");
  out.accuracy = read_direct_accuracy(read, root.find("accuracy"));
  out.origin_mm = read_polynomial_vector(read, root.find("origin"));
  out.direction = read_polynomial_vector(read, root.find("direction"));
  out.inner = read_polynomial_vector(read, root.find("inner"));
  if (!read.failed()) out.rims = read_rims(read, root.find("rims"));
  if (!read.failed()) out.transmittance = read_polynomial(read, root.find("transmittance"));
  return out;
}

bool has_direct_format(const CborNode& root) {
  const CborNode* const format = root.find("format");
  return format != nullptr && format->text == kDirectFormat;
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

std::string write_direct_polynomials(const DirectPolynomials& polynomials) {
  CborNode root;
  root.add("format", cbor_text(std::string(kDirectFormat)));
  root.add("version", cbor_number(kDirectVersion));
  root.add("lens", cbor_text(polynomials.lens));
  root.add("fingerprint", cbor_text(fmt::format("{:016x}", polynomials.fingerprint)));
  root.add("focal_length_mm", cbor_number(polynomials.focal_length_mm));
  root.add("front_z_mm", cbor_number(polynomials.front_z_mm));
  root.add("sensor_z_mm", cbor_number(polynomials.sensor_z_mm));
  root.add("stop_radius_mm", cbor_number(polynomials.stop_radius_mm));
  root.add("max_height_mm", cbor_number(polynomials.max_height_mm));
  root.add("pixel_mm", cbor_number(polynomials.pixel_mm));
  root.add("wavelengths_nm", cbor_list({cbor_number(polynomials.shortest_nm), cbor_number(polynomials.longest_nm)}));
  root.add("accuracy", node_of(polynomials.accuracy));
  root.add("origin", vector_node(polynomials.origin_mm));
  root.add("direction", vector_node(polynomials.direction));
  root.add("inner", vector_node(polynomials.inner));
  root.add("rims", rims_node(polynomials.rims));
  root.add("transmittance", sum_node(polynomials.transmittance));
  return write_cbor(root);
}

Result<DirectPolynomials> read_direct_polynomials(std::string_view bytes, const std::string& file) {
  const auto root = parse_cbor(bytes, file);
  if (!root) return tl::unexpected(root.error());
  if (!has_direct_format(*root))
    return failure(ErrorCode::Parse, fmt::format("not a file of the direct image's polynomials; {}", kDirectRemedy),
                   {file, 0, 0});
  const CborNode* const version = root->find("version");
  if (version == nullptr || version->number != kDirectVersion)
    return failure(ErrorCode::Parse, "a version of the format that is not known; fit the lens again", {file, 0, 0});
  PolyReader read;
  DirectPolynomials out = read_direct(read, *root);
  if (read.failed()) return failure(ErrorCode::Parse, *read.error(), {file, 0, 0});
  return out;
}

Result<DirectPolynomials> read_direct_polynomial_file(const std::filesystem::path& file) {
  const auto bytes = read_text_file(file, kMaxDirectBytes, std::string(kDirectRemedy));
  if (!bytes) return tl::unexpected(bytes.error());
  return read_direct_polynomials(*bytes, file.string());
}

bool is_direct_polynomial_file(const std::filesystem::path& file) {
  const auto bytes = read_text_file(file, kMaxDirectBytes, "");
  if (!bytes) return false;
  const auto root = parse_cbor(*bytes, file.string());
  return root && has_direct_format(*root);
}

}  // namespace contrejour
