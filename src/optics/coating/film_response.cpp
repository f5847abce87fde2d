// SPDX-License-Identifier: Apache-2.0
// Abeles characteristic matrices in the convention exp(-i w t). Each film's matrix maps the tangential fields
// (E, H) at its back to those at its front; with sin(delta) / cos(theta) kept as one factor, a film at its
// critical angle needs no special case.
#include <cmath>
#include <numbers>
#include <optional>

#include "contrejour/expert/coating.h"

namespace contrejour {
namespace {

using Complex = std::complex<double>;

// Beyond this attenuation (nepers) a film returns nothing measurable; the limit keeps cosh finite.
constexpr double kDeepestAttenuation = 300.0;
constexpr double kSmallPhase = 1e-4;  // below it sin(x)/x = 1 - x^2/6 is exact to rounding

// Cosine of the ray angle in a medium by Snell's law, on the branch that propagates or decays forwards.
Complex forward_cosine(Complex n, Complex n_sin) {
  const Complex sine = n_sin / n;
  Complex cosine = std::sqrt(1.0 - sine * sine);
  const Complex along = n * cosine;
  const bool backwards = std::abs(along.imag()) > 1e-14 * std::abs(along) ? along.imag() < 0.0 : along.real() < 0.0;
  return backwards ? -cosine : cosine;
}

// A film without absorption, at an angle at which light propagates in it: all factors of its matrix are real.
struct RealFilm {
  double n = 1.0, cosine = 1.0, thickness = 0.0;  // 2 pi n d / lambda
};
std::optional<RealFilm> real_film(Complex n_sin, const FilmLayer& layer, double lambda_nm) {
  const Complex n = index_at(layer.material, lambda_nm);
  if (n.imag() != 0.0 || n_sin.imag() != 0.0) return std::nullopt;
  const double sine = n_sin.real() / n.real();
  constexpr double kTravels = 1.0 - 1e-6;  // closer to the critical angle sin(delta) / cos(theta) loses accuracy
  if (!(sine * sine < kTravels)) return std::nullopt;
  return RealFilm{n.real(), std::sqrt(1.0 - sine * sine),
                  2.0 * std::numbers::pi * layer.thickness_nm / lambda_nm * n.real()};
}

Complex sinc(Complex x) { return std::abs(x) < kSmallPhase ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

struct Fields {
  Complex e, h;
};

// admittance_sin = eta sin(delta), impedance_sin = sin(delta) / eta
Fields through_film(const Fields& back, Complex delta, Complex admittance_sin, Complex impedance_sin) {
  const Complex i(0.0, 1.0);
  const Complex cosine = std::cos(delta);
  return {cosine * back.e - i * impedance_sin * back.h, cosine * back.h - i * admittance_sin * back.e};
}

// The same with real factors, in a sixth of the time.
Fields through_film(const Fields& back, double cosine, double admittance_sin, double impedance_sin) {
  return {
      {cosine * back.e.real() + impedance_sin * back.h.imag(), cosine * back.e.imag() - impedance_sin * back.h.real()},
      {cosine * back.h.real() + admittance_sin * back.e.imag(),
       cosine * back.h.imag() - admittance_sin * back.e.real()}};
}

// The fields of both polarisations; p is scaled by the cosine behind the films so that grazing exit stays finite.
struct BothFields {
  Fields s, p;
};

void pass(const RealFilm& film, BothFields& at) {
  const double delta = film.thickness * film.cosine;
  const double cosine = std::cos(delta), sine = std::sin(delta);
  const double sine_over_cosine = sine / film.cosine, sine_times_cosine = sine * film.cosine;
  at.s = through_film(at.s, cosine, film.n * sine_times_cosine, sine_over_cosine / film.n);
  at.p = through_film(at.p, cosine, film.n * sine_over_cosine, sine_times_cosine / film.n);
}

void pass(const FilmLayer& film, Complex n_sin, double lambda_nm, BothFields& at) {
  const Complex n = index_at(film.material, lambda_nm);
  const Complex cosine = forward_cosine(n, n_sin);
  const Complex thickness = 2.0 * std::numbers::pi * film.thickness_nm / lambda_nm * n;
  Complex delta = thickness * cosine;
  if (delta.imag() > kDeepestAttenuation) delta.imag(kDeepestAttenuation);
  const Complex sine_over_cosine = thickness * sinc(delta);  // sin(delta) / cos(theta)
  const Complex sine_times_cosine = std::sin(delta) * cosine;
  at.s = through_film(at.s, delta, n * sine_times_cosine, sine_over_cosine / n);
  at.p = through_film(at.p, delta, n * sine_over_cosine, sine_times_cosine / n);
}

}  // namespace

FilmResponse film_response(Complex n_in, std::span<const FilmLayer> layers, Complex n_out, double theta_in_rad,
                           double lambda_nm, FilmOrder order) {
  const Complex n_sin = n_in * std::sin(theta_in_rad);
  const Complex cos_in = std::cos(theta_in_rad);
  const Complex cos_out = forward_cosine(n_out, n_sin);

  BothFields at{{1.0, n_out * cos_out}, {cos_out, n_out}};  // at the back, for a unit transmitted wave
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const FilmLayer& film = layers[order == FilmOrder::AsListed ? layers.size() - 1 - k : k];
    if (const auto real = real_film(n_sin, film, lambda_nm))
      pass(*real, at);
    else
      pass(film, n_sin, lambda_nm, at);
  }
  const auto& [s, p] = at;

  FilmResponse out;
  const Complex s_sum = n_in * cos_in * s.e + s.h;
  const Complex p_sum = n_in * p.e + cos_in * p.h;
  out.r_s = (n_in * cos_in * s.e - s.h) / s_sum;
  out.r_p = -(n_in * p.e - cos_in * p.h) / p_sum;
  out.t_s = 2.0 * n_in * cos_in / s_sum;
  out.t_p = 2.0 * n_in * cos_in / p_sum;
  out.R_s = std::norm(out.r_s);
  out.R_p = std::norm(out.r_p);
  // Power along the normal: Re(n cos) for s, Re(n conj(cos)) for p.
  const double in_s = (n_in * cos_in).real();
  const double in_p = (n_in * std::conj(cos_in)).real();
  out.T_s = in_s > 0.0 ? std::norm(out.t_s) * (n_out * cos_out).real() / in_s : 0.0;
  out.T_p = in_p > 0.0 ? std::norm(out.t_p) * (n_out * std::conj(cos_out)).real() / in_p : 0.0;
  return out;
}

}  // namespace contrejour
