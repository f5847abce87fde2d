// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "contrejour/expert/glass.h"

namespace contrejour {

GlassFigures glass_figures(const Glass& glass) {
  const auto n = [&](double nm) { return refractive_index(glass, nm); };
  const double f_c = n(kLineF_nm) - n(kLineC_nm);
  GlassFigures figures;
  figures.n_d = n(kLineD_nm);
  figures.v_d = (figures.n_d - 1.0) / f_c;
  figures.v_e = (n(kLineE_nm) - 1.0) / (n(kLineFPrime_nm) - n(kLineCPrime_nm));
  figures.p_gf = (n(kLineG_nm) - n(kLineF_nm)) / f_c;
  figures.d_pgf = figures.p_gf - normal_p_gf(figures.v_d);
  return figures;
}

std::optional<Glass> glass_of_code(std::string_view code) {
  constexpr std::size_t kDigits = 6;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t k = 0; k < code.size(); ++k)
    if (!is_digit(code[k]) && !(k == kDigits && code[k] == '.')) return std::nullopt;
  if (code.size() < kDigits || code.size() == kDigits + 1 || code.size() > kDigits + 4) return std::nullopt;
  if (code.size() > kDigits && code[kDigits] != '.') return std::nullopt;
  int thousandths = 0, tenths = 0;
  std::from_chars(code.data(), code.data() + 3, thousandths);
  std::from_chars(code.data() + 3, code.data() + kDigits, tenths);
  // The digits' own decimal values: 1.517, not 1 + 517 / 1000.
  const ModelGlass model{(1000 + thousandths) / 1000.0, tenths / 10.0, 0.0};
  if (thousandths == 0 || tenths < 50) return std::nullopt;  // no glass has such a dispersion
  return Glass{std::string(code), model};
}

}  // namespace contrejour
