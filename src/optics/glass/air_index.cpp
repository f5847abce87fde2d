// SPDX-License-Identifier: Apache-2.0
// Effects of temperature and pressure on air and glass: docs/physics/glass.md.
#include <cmath>

#include "base/units.h"
#include "contrejour/expert/glass.h"

namespace contrejour {
namespace {

constexpr double kAirReference_c = 15.0;  // of Kohlrausch's dispersion, at 1 atm
constexpr double kAirExpansion_per_k = 3.4785e-3;

// Change of the absolute index from the reference temperature: Schott TIE-19 eq. 6, as in AGF files.
double thermal_change(const ThermalDispersion& t, double n, double lambda_um, double dt_k) {
  const double resonance = t.lambda_tk_um * std::abs(t.lambda_tk_um);
  const double change =
      dt_k * (t.d0 + dt_k * (t.d1 + dt_k * t.d2)) + dt_k * (t.e0 + dt_k * t.e1) / (lambda_um * lambda_um - resonance);
  return change * (n * n - 1.0) / (2.0 * n);
}

}  // namespace

double air_index(double lambda_nm, const AirState& air) {
  const double l2 = um_from_nm(lambda_nm) * um_from_nm(lambda_nm);
  const double at_reference = 6432.8 + 2949810.0 * l2 / (146.0 * l2 - 1.0) + 25540.0 * l2 / (41.0 * l2 - 1.0);
  const double thinning = 1.0 + (air.temperature_c - kAirReference_c) * kAirExpansion_per_k;
  return 1.0 + at_reference * 1e-8 * air.pressure_atm / thinning;
}

double refractive_index(const Glass& glass, double lambda_nm, const AirState& air) {
  const auto* known = std::get_if<CatalogueGlass>(&glass.dispersion);
  const AirState reference{known != nullptr ? known->data().reference_temperature_c : AirState{}.temperature_c, 1.0};
  const bool same = air.temperature_c == reference.temperature_c && air.pressure_atm == reference.pressure_atm;
  if (same || is_air(glass)) return refractive_index(glass, lambda_nm);
  // The same light has another wavelength in the catalogue's air.
  const double n_air = air_index(lambda_nm, air);
  const double n_reference_air = air_index(lambda_nm, reference);
  const double there_nm = lambda_nm * n_air / n_reference_air;
  const double n = refractive_index(glass, there_nm);
  double absolute = n * n_reference_air;
  if (known != nullptr && known->data().thermal) {
    absolute +=
        thermal_change(*known->data().thermal, n, um_from_nm(there_nm), air.temperature_c - reference.temperature_c);
  }
  return absolute / n_air;
}

}  // namespace contrejour
