// SPDX-License-Identifier: Apache-2.0
#include "optics/glass/buchdahl_model.h"

#include "base/units.h"
#include "optics/glass/formulas.h"

namespace contrejour::inline internal {

double model_index(const ModelGlass& glass, double lambda_um) {
  if (glass.v_d == 0.0) return glass.n_d;
  constexpr std::array kCoordinate{um_from_nm(kLineD_nm), 0.0, 1.0};
  const auto w_at = [&](double um) { return formula_index(DispersionFormula::Buchdahl, kCoordinate, um); };
  const double wg = w_at(um_from_nm(kLineG_nm)), wf = w_at(um_from_nm(kLineF_nm)), wc = w_at(um_from_nm(kLineC_nm));
  // v1 (wF - wC) + v2 (wF^2 - wC^2) = n_F - n_C and the same of g and F, by Cramer's rule.
  const double f_c = (glass.n_d - 1.0) / glass.v_d;
  const double g_f = f_c * (normal_p_gf(glass.v_d) + glass.d_pgf);
  const double a1 = wf - wc, a2 = wf * wf - wc * wc;
  const double b1 = wg - wf, b2 = wg * wg - wf * wf;
  const double determinant = a1 * b2 - a2 * b1;
  const double v1 = (f_c * b2 - g_f * a2) / determinant;
  const double v2 = (a1 * g_f - b1 * f_c) / determinant;
  const double w = w_at(lambda_um);
  return glass.n_d + w * (v1 + v2 * w);
}

}  // namespace contrejour::inline internal
