// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/coating.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "contrejour/expert/film_design.h"
#include "optics/surface/surface-inl.h"

namespace contrejour {
namespace {

namespace hk = kernels::HWY_NAMESPACE;

// Squared cosine in the medium behind, by Snell's law; negative beyond the critical angle.
double cos_squared_behind(double n_in, double n_out, double cos_in) {
  const double eta = n_in / n_out;
  return 1.0 - eta * eta * (1.0 - cos_in * cos_in);
}

FilmResponse stack_response(std::span<const FilmLayer> layers, double n_in, double n_out, double cos_in,
                            double lambda_nm) {
  const double theta = std::acos(std::clamp(cos_in, 0.0, 1.0));
  return film_response(n_in, layers, n_out, theta, lambda_nm,
                       n_in <= n_out ? FilmOrder::AsListed : FilmOrder::Reversed);
}

double mean_reflectance(const FilmResponse& r) { return 0.5 * (r.R_s + r.R_p); }

double reflectance_of(const Bare&, double n_in, double n_out, double cos_in, double) {
  const double cos2 = cos_squared_behind(n_in, n_out, cos_in);
  if (cos2 <= 0.0) return 1.0;
  return hk::mean_power(hk::fresnel(n_in, cos_in, n_out, std::sqrt(cos2)));
}

double reflectance_of(const QuarterWave& film, double n_in, double n_out, double cos_in, double lambda_nm) {
  const double cos2_out = cos_squared_behind(n_in, n_out, cos_in);
  if (cos2_out <= 0.0) return 1.0;
  const double cos2_film = cos_squared_behind(n_in, film.n, cos_in);
  if (cos2_film <= 0.0) {  // an evanescent wave in the film: no real angle
    const FilmLayer layer{film.n, film.lambda0_nm / (4.0 * film.n)};
    return mean_reflectance(film_response(n_in, {&layer, 1}, n_out, std::acos(cos_in), lambda_nm));
  }
  const double two_delta = std::numbers::pi * film.lambda0_nm / lambda_nm;  // 4 pi n d / lambda with n d = lambda0 / 4
  return hk::single_film_power(n_in, cos_in, film.n, std::sqrt(cos2_film), n_out, std::sqrt(cos2_out), two_delta);
}

double reflectance_of(const FilmStack& stack, double n_in, double n_out, double cos_in, double lambda_nm) {
  return mean_reflectance(stack_response(stack.layers, n_in, n_out, cos_in, lambda_nm));
}

// hullin2011, supplement, FresnelAR, as printed. It is 0/0 at normal incidence: theta is kept above 1e-4 rad,
// where the formula is within 1e-8 of its limit.
double reflectance_of(const HullinFresnelAR& film, double n0, double n2, double cos_in, double lambda_nm) {
  const double theta0 = std::max(1e-4, std::acos(std::clamp(cos_in, 0.0, 1.0)));
  const double sine1 = std::sin(theta0) * n0 / film.n;
  const double sine2 = std::sin(theta0) * n0 / n2;
  if (sine1 >= 1.0 || sine2 >= 1.0) return 1.0;
  const double theta1 = std::asin(sine1);
  const double theta2 = std::asin(sine2);
  const double rs01 = -std::sin(theta0 - theta1) / std::sin(theta0 + theta1);
  const double rp01 = std::tan(theta0 - theta1) / std::tan(theta0 + theta1);
  const double ts01 = 2 * std::sin(theta1) * std::cos(theta0) / std::sin(theta0 + theta1);
  const double tp01 = ts01 * std::cos(theta0 - theta1);
  const double rs12 = -std::sin(theta1 - theta2) / std::sin(theta1 + theta2);
  const double rp12 = std::tan(theta1 - theta2) / std::tan(theta1 + theta2);
  const double ris = ts01 * ts01 * rs12;
  const double rip = tp01 * tp01 * rp12;
  const double dy = film.lambda0_nm / 4.0;  // d1 * n1
  const double dx = std::tan(theta1) * dy;
  const double delay = std::hypot(dx, dy);
  const double phase = 4 * std::numbers::pi / lambda_nm * (delay - dx * std::sin(theta0));
  const double s2 = rs01 * rs01 + ris * ris + 2 * rs01 * ris * std::cos(phase);
  const double p2 = rp01 * rp01 + rip * rip + 2 * rp01 * rip * std::cos(phase);
  return std::min(1.0, 0.5 * (s2 + p2));
}

double reflectance_of(const DesignedCoating& design, double n_in, double n_out, double cos_in, double lambda_nm) {
  const FilmStack stack = designed_for(design, {"", ConstantIndex{std::max(n_in, n_out)}});
  return reflectance_of(stack, n_in, n_out, cos_in, lambda_nm);
}

// The position of a value in a rising list: the entry below it, and the fraction of the interval to the next; values
// beyond the ends are clamped.
struct Between {
  std::size_t first = 0, next = 0;
  double fraction = 0.0;
};
Between between(const std::vector<double>& list, double value) {
  const auto above = std::upper_bound(list.begin(), list.end(), value);
  if (above == list.begin()) return {};
  const auto next = static_cast<std::size_t>(above - list.begin());
  if (above == list.end()) return {next - 1, next - 1, 0.0};
  return {next - 1, next, (value - list[next - 1]) / (list[next] - list[next - 1])};
}

// Reflectances are measured from the side of the lower index; from the other side they are equal at the refracted
// angle.
double reflectance_of(const MeasuredCoating& measured, double n_in, double n_out, double cos_in, double lambda_nm) {
  const std::size_t wanted = measured.lambda_nm.size() * measured.angle_deg.size();
  if (wanted == 0 || measured.reflectance.size() != wanted) return std::nan("");
  const double cos2_out = cos_squared_behind(n_in, n_out, cos_in);
  if (cos2_out <= 0.0) return 1.0;
  const double outside = n_in > n_out ? std::sqrt(cos2_out) : cos_in;
  const double angle_deg = std::acos(std::clamp(outside, 0.0, 1.0)) * 180.0 / std::numbers::pi;
  const Between line = between(measured.lambda_nm, lambda_nm), column = between(measured.angle_deg, angle_deg);
  const auto at = [&](std::size_t row) {
    const double* const values = measured.reflectance.data() + row * measured.angle_deg.size();
    return std::lerp(values[column.first], values[column.next], column.fraction);
  };
  return std::lerp(at(line.first), at(line.next), line.fraction);
}

std::string text_of(const Bare&) { return "none"; }
std::string text_of(const QuarterWave& f) { return fmt::format("quarter-wave {:g} nm, n = {:g}", f.lambda0_nm, f.n); }
std::string text_of(const FilmStack& f) { return fmt::format("stack of {} layers", f.layers.size()); }
std::string text_of(const MeasuredCoating& f) {
  return fmt::format("measured at {} wavelengths, {} angles", f.lambda_nm.size(), f.angle_deg.size());
}
std::string text_of(const DesignedCoating& f) { return fmt::format("{} {:g} nm", design_name(f), f.lambda0_nm); }
std::string text_of(const HullinFresnelAR& f) { return fmt::format("hullin {:g} nm, n = {:g}", f.lambda0_nm, f.n); }

}  // namespace

std::string describe(const Coating& coating) {
  const std::string films = std::visit([](const auto& f) { return text_of(f); }, coating.films);
  return coating.name.empty() || coating.name == films ? films : fmt::format("{} ({})", coating.name, films);
}

double reflectance(const Coating& coating, double n_in, double n_out, double cos_in, double lambda_nm) {
  return std::visit([&](const auto& f) { return reflectance_of(f, n_in, n_out, cos_in, lambda_nm); }, coating.films);
}

double transmittance(const Coating& coating, double n_in, double n_out, double cos_in, double lambda_nm) {
  if (const auto* design = std::get_if<DesignedCoating>(&coating.films)) {
    const FilmStack stack = designed_for(*design, {"", ConstantIndex{std::max(n_in, n_out)}});
    return transmittance({"", stack}, n_in, n_out, cos_in, lambda_nm);
  }
  if (const auto* stack = std::get_if<FilmStack>(&coating.films)) {
    const FilmResponse r = stack_response(stack->layers, n_in, n_out, cos_in, lambda_nm);
    return 0.5 * (r.T_s + r.T_p);
  }
  return 1.0 - reflectance(coating, n_in, n_out, cos_in, lambda_nm);
}

Coating at_wavelength(const Coating& coating, double lambda_nm) {
  const auto* const stack = std::get_if<FilmStack>(&coating.films);
  if (stack == nullptr) return coating;
  FilmStack fixed = *stack;
  for (FilmLayer& layer : fixed.layers) layer.material = index_at(layer.material, lambda_nm);
  return {coating.name, std::move(fixed)};
}

bool may_absorb(const Coating& coating) {
  return std::holds_alternative<FilmStack>(coating.films) || std::holds_alternative<DesignedCoating>(coating.films);
}

}  // namespace contrejour
