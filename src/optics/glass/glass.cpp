// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/glass.h"

#include <cmath>

#include "base/units.h"
#include "optics/glass/buchdahl_model.h"
#include "optics/glass/formulas.h"

namespace contrejour {
namespace {

double index_of(const ConstantIndex& glass, double) { return glass.n; }

// n = A + B / lambda^2 with n(d) = n_d and n(F) - n(C) = (n_d - 1) / v_d.
double index_of(const AbbeGlass& glass, double lambda_nm) {
  if (glass.v_d == 0.0) return glass.n_d;
  const auto inverse_square = [](double nm) { return 1.0 / (um_from_nm(nm) * um_from_nm(nm)); };
  const double b = (glass.n_d - 1.0) / (glass.v_d * (inverse_square(kLineF_nm) - inverse_square(kLineC_nm)));
  return glass.n_d + b * (inverse_square(lambda_nm) - inverse_square(kLineD_nm));
}

// hullin2011 eq. 1; lambda um.
double index_of(const Sellmeier& glass, double lambda_nm) {
  const double l2 = um_from_nm(lambda_nm) * um_from_nm(lambda_nm);
  double n2 = 1.0;
  for (std::size_t k = 0; k < glass.b.size(); ++k) n2 += glass.b[k] * l2 / (l2 - glass.c_um2[k]);
  return std::sqrt(n2);
}

double index_of(const ModelGlass& glass, double lambda_nm) { return model_index(glass, um_from_nm(lambda_nm)); }

// The catalogue's own index; one against vacuum is divided by that of air, at the wavelength in air.
double index_of(const CatalogueGlass& glass, double lambda_nm) {
  const GlassData& data = glass.data();
  if (!data.index_in_vacuum && !data.wavelength_in_vacuum)
    return formula_index(data.formula, data.coefficients, um_from_nm(lambda_nm));
  const double n_air = air_index(lambda_nm, {data.reference_temperature_c, 1.0});
  const double there_nm = data.wavelength_in_vacuum ? lambda_nm * n_air : lambda_nm;
  const double n = formula_index(data.formula, data.coefficients, um_from_nm(there_nm));
  return data.index_in_vacuum ? n / n_air : n;
}

}  // namespace

double refractive_index(const Glass& glass, double lambda_nm) {
  // Every path needs this: the short formulas are inlined here, which std::visit over all five would prevent.
  if (const auto* constant = std::get_if<ConstantIndex>(&glass.dispersion)) return index_of(*constant, lambda_nm);
  if (const auto* abbe = std::get_if<AbbeGlass>(&glass.dispersion)) return index_of(*abbe, lambda_nm);
  if (const auto* sellmeier = std::get_if<Sellmeier>(&glass.dispersion)) return index_of(*sellmeier, lambda_nm);
  if (const auto* model = std::get_if<ModelGlass>(&glass.dispersion)) return index_of(*model, lambda_nm);
  return index_of(std::get<CatalogueGlass>(glass.dispersion), lambda_nm);
}

std::optional<WavelengthRange> wavelength_range_nm(const Glass& glass) {
  if (const auto* known = std::get_if<CatalogueGlass>(&glass.dispersion)) return known->data().range_nm;
  return std::nullopt;
}

bool is_air(const Glass& glass) {
  const auto* constant = std::get_if<ConstantIndex>(&glass.dispersion);
  return constant != nullptr && constant->n == 1.0;
}

}  // namespace contrejour
