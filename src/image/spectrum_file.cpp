// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/spectrum_file.h"

#include <charconv>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/text_file.h"
#include "base/trimmed.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
constexpr double kShortestNm = 1.0;
constexpr double kLongestNm = 1e5;
constexpr double kMaxPower = 1e30;

// A finite number and what follows it; false if there is none.
bool take_number(std::string_view& text, double& value) {
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc{} || !std::isfinite(value)) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

// "435.8, 1.25": two numbers, one separator between them, no more.
bool read_point(std::string_view line, SpectrumPoint& point) {
  if (!take_number(line, point.lambda_nm)) return false;
  const std::size_t gap = line.size();
  line = trimmed(line);
  const bool marked = !line.empty() && (line.front() == ',' || line.front() == ';');
  if (!marked && line.size() == gap) return false;  // nothing between them
  if (marked) line = trimmed(line.substr(1));
  return take_number(line, point.power) && line.empty();
}

// Recognises headings such as "wavelength, power"; a line that begins like a number is no heading.
bool is_heading(std::string_view line) {
  return line.find_first_of("0123456789.+-") != 0 && line.find_first_not_of(" -~") != std::string_view::npos;
}

std::string quoted(std::string_view line) {
  std::string shown;
  for (const char c : line.substr(0, 40)) shown += c >= ' ' && c <= '~' ? c : '?';
  return '"' + shown + '"';
}

// The problem of a point after its predecessors; empty if there is none.
std::string problem_with(const SpectrumPoint& point, const std::vector<SpectrumPoint>& before) {
  if (!(point.lambda_nm >= kShortestNm && point.lambda_nm <= kLongestNm))
    return fmt::format("a wavelength of {} nm is out of range; give {} to {} nm", point.lambda_nm, kShortestNm,
                       kLongestNm);
  if (!(point.power >= 0.0 && point.power <= kMaxPower))
    return fmt::format("a power of {} is out of range; give 0 to {}", point.power, kMaxPower);
  if (!before.empty() && !(point.lambda_nm > before.back().lambda_nm))
    return fmt::format("{} nm comes after {} nm; let wavelengths rise", point.lambda_nm, before.back().lambda_nm);
  return {};
}

}  // namespace

Result<TabulatedSpectrum> read_spectrum(std::string_view text, const std::string& file) {
  const auto wrong = [&](int line, std::string why) { return failure(ErrorCode::Parse, std::move(why), {file, line}); };
  if (text.size() > kMaxBytes) return wrong(0, fmt::format("larger than {} bytes; no spectrum is", kMaxBytes));
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<SpectrumPoint> points;
  bool may_be_heading = true;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, std::min(end, text.find('#'))));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    SpectrumPoint point;
    if (!read_point(line, point)) {
      if (std::exchange(may_be_heading, false) && is_heading(line)) continue;
      return wrong(number, fmt::format("{} is not a wavelength in nm and a power, as in 589.3,1", quoted(line)));
    }
    may_be_heading = false;
    if (std::string why = problem_with(point, points); !why.empty()) return wrong(number, std::move(why));
    points.push_back(point);
  }
  if (points.size() < 2) return wrong(0, "fewer than two lines of wavelength and power; a line needs two at least");
  TabulatedSpectrum spectrum{std::make_shared<const std::vector<SpectrumPoint>>(std::move(points))};
  if (!is_visible(spectrum)) return wrong(0, "nothing of this spectrum is visible, 360 to 830 nm");
  return spectrum;
}

Result<TabulatedSpectrum> read_spectrum(const std::filesystem::path& file) {
  const auto text = read_text_file(file, kMaxBytes, "name one of the bundled lamps");
  if (!text) return tl::unexpected(text.error());
  return read_spectrum(*text, file.string());
}

std::string write_spectrum(const TabulatedSpectrum& spectrum) {
  if (!spectrum.points) return "";
  std::string text = "wavelength_nm,power\n";
  for (const SpectrumPoint& p : *spectrum.points) text += fmt::format("{},{}\n", p.lambda_nm, p.power);
  return text;
}

}  // namespace contrejour
