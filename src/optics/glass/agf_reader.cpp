// SPDX-License-Identifier: Apache-2.0
// AGF catalogues (Zemax): lines of a two-letter tag and values. docs/formats/glass.md.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/decode_text.h"
#include "base/near_name.h"
#include "contrejour/expert/glass_catalogue.h"
#include "optics/glass/formulas.h"
#include "optics/glass/glass_limits.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxGlasses = 20000;
constexpr std::size_t kMaxWarnings = 100;
constexpr std::size_t kMaxTagNumbers = 10;      // of one tag
constexpr std::size_t kMaxTransmittances = 2000;
// Transmittances are printed with three decimals: a printed 0 is below half of the last digit.
constexpr double kMinTransmittance = 0.0005;
constexpr double kStatedTolerance = 1e-3;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kSpace = " \t";
  for (std::size_t at = line.find_first_not_of(kSpace); at != std::string_view::npos && words.size() < 32;) {
    const std::size_t end = std::min(line.find_first_of(kSpace, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kSpace, end);
  }
  return words;
}

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool starts_as_number(std::string_view word) {
  return !word.empty() && std::string_view("0123456789+-.").find(word.front()) != std::string_view::npos;
}

// A glass while its lines are read.
struct Draft {
  std::string name;
  int line = 0;
  double formula = 0.0;
  std::string code;
  double n_d = 0.0, v_d = 0.0;
  GlassStatus status = GlassStatus::Standard;
  std::vector<double> coefficients, thermal;
  std::optional<WavelengthRange> range_nm;
  std::vector<Absorption> absorption;
  std::string problem;  // the first, with its line
};

class AgfReader {
 public:
  AgfReader(const std::string& file, const std::string& maker) : file_(file), maker_(maker) {}

  Result<GlassFile> read(std::string_view text);

 private:
  void read_line(std::string_view line);
  void begin_glass(const std::vector<std::string_view>& words);
  void read_numbers(const std::vector<std::string_view>& words, std::size_t first, std::vector<double>& to);
  void read_range(const std::vector<std::string_view>& words);
  void read_transmittance(const std::vector<std::string_view>& words);
  void end_glass();
  void check_stated(const Draft& draft, const Glass& glass);
  void problem(std::string what) {
    if (draft_ && draft_->problem.empty()) draft_->problem = fmt::format("{}:{}: {}", file_, line_, what);
  }
  void warn(std::string text) {
    if (found_.warnings.size() > kMaxWarnings) return;
    if (found_.warnings.size() == kMaxWarnings) text = fmt::format("{}: more warnings are not shown", file_);
    found_.warnings.push_back(std::move(text));
  }

  const std::string& file_;
  const std::string& maker_;
  int line_ = 0;
  std::size_t named_ = 0;
  std::optional<Draft> draft_;
  std::vector<double>* open_ = nullptr;  // the list that the next line may continue
  GlassFile found_;
};

void AgfReader::begin_glass(const std::vector<std::string_view>& words) {
  end_glass();
  ++named_;
  draft_.emplace();
  draft_->line = line_;
  if (words.size() < 3) return problem("NM needs a name and the number of a formula");
  draft_->name = shortened(words[1]);
  const auto formula = number_of(words[2]);
  if (!formula) return problem(fmt::format("'{}' is not the number of a formula", shortened(words[2])));
  draft_->formula = *formula;
  const auto number_at = [&](std::size_t k) {
    const double value = words.size() > k ? number_of(words[k]).value_or(0.0) : 0.0;
    return std::isfinite(value) ? value : 0.0;
  };
  if (words.size() > 3 && glass_of_code(words[3])) draft_->code = words[3];
  draft_->n_d = number_at(4);
  draft_->v_d = number_at(5);
  const double status = number_at(7);
  if (status >= 0.0 && status <= 4.0) draft_->status = static_cast<GlassStatus>(static_cast<int>(status));
}

void AgfReader::read_numbers(const std::vector<std::string_view>& words, std::size_t first, std::vector<double>& to) {
  for (std::size_t k = first; k < words.size(); ++k) {
    const auto value = number_of(words[k]);
    if (!value) return problem(fmt::format("'{}' is not a number", shortened(words[k])));
    if (to.size() == kMaxTagNumbers) return problem(fmt::format("more than {} numbers", kMaxTagNumbers));
    to.push_back(*value);
  }
}

void AgfReader::read_range(const std::vector<std::string_view>& words) {
  if (words.size() < 3) return;
  const auto first = number_of(words[1]), last = number_of(words[2]);
  if (!first || !last) return problem("LD needs the first and the last wavelength, in um");
  draft_->range_nm = WavelengthRange{*first * 1e3, *last * 1e3};
}

// Wavelength um, transmittance, thickness mm. A row with a blank, no thickness or a negative transmittance was not
// measured.
void AgfReader::read_transmittance(const std::vector<std::string_view>& words) {
  if (words.size() < 4) return;
  const auto um = number_of(words[1]), tau = number_of(words[2]), mm = number_of(words[3]);
  if (!um || !tau || !mm) return problem("IT needs a wavelength (um), a transmittance and a thickness (mm)");
  if (!std::isfinite(*um + *tau + *mm) || *um <= 0.0)
    return problem("IT has a figure that is not a number, or no wavelength");
  if (*mm <= 0.0 || *tau < 0.0) return;
  if (draft_->absorption.size() == kMaxTransmittances) return problem("too many IT lines");
  draft_->absorption.push_back({*um * 1e3, -std::log(std::clamp(*tau, kMinTransmittance, 1.0)) / *mm + 0.0});
}

void AgfReader::read_line(std::string_view line) {
  const auto words = words_of(line);
  if (words.empty()) return;
  const std::string_view tag = words[0];
  if (tag == "NM") return begin_glass(words);
  if (!draft_) return;
  if (open_ != nullptr && starts_as_number(tag)) return read_numbers(words, 0, *open_);
  open_ = nullptr;
  if (tag == "CD" || tag == "TD") {
    open_ = tag == "CD" ? &draft_->coefficients : &draft_->thermal;
    open_->clear();
    read_numbers(words, 1, *open_);
  } else if (tag == "LD") {
    read_range(words);
  } else if (tag == "IT") {
    read_transmittance(words);
  }
}

GlassData data_of(Draft& draft) {
  GlassData data;
  data.formula = static_cast<DispersionFormula>(static_cast<int>(draft.formula));
  data.coefficients = std::move(draft.coefficients);
  // Files pad the line with zeros.
  const std::size_t max = coefficient_count(data.formula).max;
  while (data.coefficients.size() > max && data.coefficients.back() == 0.0) data.coefficients.pop_back();
  data.range_nm = draft.range_nm;
  const auto& t = draft.thermal;
  if (t.size() >= 6) data.thermal = ThermalDispersion{t[0], t[1], t[2], t[3], t[4], t[5]};
  if (t.size() >= 7) data.reference_temperature_c = t[6];
  std::stable_sort(draft.absorption.begin(), draft.absorption.end(),
                   [](const Absorption& a, const Absorption& b) { return a.lambda_nm < b.lambda_nm; });
  const auto same = [](const Absorption& a, const Absorption& b) { return a.lambda_nm == b.lambda_nm; };
  draft.absorption.erase(std::unique(draft.absorption.begin(), draft.absorption.end(), same), draft.absorption.end());
  data.absorption = std::move(draft.absorption);
  return data;
}

void AgfReader::check_stated(const Draft& draft, const Glass& glass) {
  const double n_d = refractive_index(glass, kLineD_nm);
  if (draft.n_d == 0.0 || std::abs(n_d - draft.n_d) <= kStatedTolerance) return;
  const auto range = wavelength_range_nm(glass);
  if (range && (range->first_nm > kLineD_nm || range->last_nm < kLineD_nm)) return;  // a glass for other wavelengths
  warn(fmt::format("{}:{}: glass '{}' states n_d {} and its formula gives {:.6f}; the formula is used", file_,
                   draft.line, draft.name, draft.n_d, n_d));
}

void AgfReader::end_glass() {
  open_ = nullptr;
  if (!draft_) return;
  Draft draft = std::move(*draft_);
  draft_.reset();
  if (!draft.problem.empty()) return warn(draft.problem + fmt::format("; glass '{}' is left out", draft.name));
  if (!(draft.formula >= 1.0 && draft.formula <= 13.0) || draft.formula != std::floor(draft.formula)) {
    return warn(fmt::format("{}:{}: glass '{}' has formula {}; known are 1 to 13; it is left out", file_, draft.line,
                            draft.name, draft.formula));
  }
  auto glass = make_glass(draft.name, data_of(draft));
  if (!glass) return warn(fmt::format("{}:{}: {}; it is left out", file_, draft.line, glass.error().message));
  check_stated(draft, *glass);
  CatalogueEntry entry{{draft.name, maker_, draft.code, draft.status, draft.n_d, draft.v_d}, std::move(*glass), file_};
  fill_stated(entry);
  found_.glasses.push_back(std::move(entry));
}

Result<GlassFile> AgfReader::read(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    ++line_;
    read_line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (named_ > kMaxGlasses)
      return failure(ErrorCode::Parse, fmt::format("more than {} glasses; split the catalogue", kMaxGlasses),
                     {file_, line_, 0});
  }
  end_glass();
  if (named_ == 0)
    return failure(ErrorCode::Parse, "no line begins with NM: this is not an AGF catalogue; check the file",
                   {file_, 0, 0});
  if (found_.glasses.empty()) {
    return failure(ErrorCode::Parse,
                   fmt::format("none of its {} glasses can be read; the first: {}", named_, found_.warnings.front()),
                   {file_, 0, 0});
  }
  return std::move(found_);
}

}  // namespace

Result<GlassFile> read_agf(std::string_view bytes, const std::string& file, const std::string& maker) {
  if (bytes.size() > kMaxGlassFileBytes) {
    return failure(ErrorCode::Parse,
                   fmt::format("{} bytes; a catalogue has at most {}", bytes.size(), kMaxGlassFileBytes), {file, 0, 0});
  }
  return AgfReader(file, maker).read(decode_text(bytes));
}

}  // namespace contrejour
