// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/plate.h"

#include <array>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/output_file.h"
#include "plates/plate_colour.h"
#include "plates/plate_format.h"

namespace contrejour {
namespace {

namespace fs = std::filesystem;

// The format of a regular file that the module reads; a pipe is left to read_picture, since it can be read once only.
std::string module_format(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 12> first{};
  stream.read(first.data(), static_cast<std::streamsize>(first.size()));
  return module_format_of(std::as_bytes(std::span(first.data(), static_cast<std::size_t>(stream.gcount()))));
}

Result<std::vector<std::byte>> read_bytes(const fs::path& file, std::uint64_t max_bytes) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return failure(ErrorCode::Io, "cannot read: " + error.message());
  if (size > max_bytes)
    return failure(ErrorCode::Unsupported, fmt::format("the file is larger than {} bytes", max_bytes));
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) return failure(ErrorCode::Io, "cannot read");
  return bytes;
}

Result<Picture> read_by_module(const fs::path& file, const std::string& format, const ReadOptions& options,
                               const PlateColour& colour, PlateSource& source) {
  if (!options.layer.empty() || !options.part.empty())
    return failure(ErrorCode::Unsupported, "only an OpenEXR file has layers and parts");
  const auto module = format_module();
  if (!module) return tl::unexpected(module.error());
  const auto bytes = read_bytes(file, options.limits.max_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  auto image = (*module)->read(*bytes, format, options.limits);
  if (!image) return tl::unexpected(image.error());
  if (image->is_film_log && colour.input_space.empty())
    return failure(ErrorCode::InvalidArgument,
                   "its values are film densities, not light; --input-space names their colour space (ADX10 for "
                   "scanned film, or the camera's log)");
  Picture picture = picture_of_coded(*image);
  image->samples = {};
  source.file = std::move(*image);
  return picture;
}

Result<Plate> read(const fs::path& file, const ReadOptions& options, const PlateColour& colour) {
  auto source = std::make_shared<PlateSource>();
  const std::string format = module_format(file);
  auto picture = format.empty() ? read_picture(file, options) : read_by_module(file, format, options, colour, *source);
  if (!picture) return tl::unexpected(picture.error());
  source->format = !format.empty() ? format : picture->header != nullptr ? "exr" : "png";
  if (!colour.input_space.empty()) {
    if (auto ok = to_working_space(*picture, colour, *source); !ok) return tl::unexpected(ok.error());
  } else if (format.empty()) {
    source = nullptr;
  }
  return Plate{std::move(*picture), std::move(source)};
}

Result<void> write(OutputFile& file, const Picture& picture, const PlateSource* source, const PlateColour& colour,
                   const Context& context) {
  const std::string format = format_of_name(file.destination());
  const bool is_same_format = source != nullptr && source->format == format;
  const std::string space = !colour.output_space.empty() ? colour.output_space : is_same_format ? source->space : "";
  if (format == "dpx" && space.empty() && !is_same_format)
    return failure(ErrorCode::InvalidArgument,
                   "a DPX has no usual colour space; --output-space names the one to write");
  const CodedImage* const from = is_same_format ? &source->file : nullptr;
  Picture coded = picture;
  if (!space.empty()) {
    const bool is_integer = format == "png" || (format != "exr" && stored_as_integers(picture, format));
    auto converted = in_space(picture, source, space, colour_config(colour), is_integer);
    if (!converted) return tl::unexpected(converted.error());
    coded = std::move(*converted);
  }
  if (format == "exr" || format == "png" || format.empty()) return write_picture(file, coded, context);
  const auto module = format_module();
  if (!module) return tl::unexpected(module.error());
  const auto bytes = (*module)->write(coded_picture(coded, format, from), format);
  if (!bytes) return tl::unexpected(bytes.error());
  if (context.cancelled()) return failure(ErrorCode::Cancelled, "cancelled");
  return file.write(*bytes);
}

// Names the file in an error that does not say where it is.
template <class Value>
Result<Value> naming(const fs::path& file, Result<Value> result) {
  if (!result && result.error().position.file.empty()) result.error().position.file = file.string();
  return result;
}

}  // namespace

Result<Plate> read_plate(const fs::path& file, const ReadOptions& options, const PlateColour& colour) {
  try {
    return naming(file, read(file, options, colour));
  } catch (const std::exception& error) {
    return failure(ErrorCode::Io, std::string("cannot read: ") + error.what(), {file.string()});
  }
}

Result<void> write_plate(OutputFile& file, const Picture& picture, const std::shared_ptr<const PlateSource>& source,
                         const PlateColour& colour, const Context& context) {
  try {
    return naming(file.destination(), write(file, picture, source.get(), colour, context));
  } catch (const std::exception& error) {
    return failure(ErrorCode::Io, std::string("cannot write: ") + error.what(), {file.destination().string()});
  }
}

bool is_plate_name(const fs::path& file) { return !format_of_name(file).empty(); }

}  // namespace contrejour
