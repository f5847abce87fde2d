// Optical media: wavelength -> refractive index, relative to air (the surrounding medium is n = 1).
// Errors: none; validity of coefficients is checked where they are read. Domain: 300 to 1100 nm for
// catalogue glasses, the visible for AbbeGlass. Thread-safety: plain values.
#pragma once

#include <array>
#include <string>
#include <variant>

namespace contrejour {

// Fraunhofer lines, nm, vacuum-independent convention of glass catalogues (in air).
inline constexpr double kLineC_nm = 656.2725;
inline constexpr double kLineD_nm = 587.5618;
inline constexpr double kLineF_nm = 486.1327;

struct ConstantIndex {
  double n = 1.0;
  friend bool operator==(const ConstantIndex&, const ConstantIndex&) = default;
};

// n(lambda) = A + B / lambda^2 through n_d and n_F - n_C = (n_d - 1) / v_d: all that a patent table
// gives. v_d = 0 means no dispersion.
struct AbbeGlass {
  double n_d = 1.5;
  double v_d = 60.0;
  friend bool operator==(const AbbeGlass&, const AbbeGlass&) = default;
};

// hullin2011 eq. 1; c in um^2.
struct Sellmeier {
  std::array<double, 3> b{};
  std::array<double, 3> c_um2{};
  friend bool operator==(const Sellmeier&, const Sellmeier&) = default;
};

struct Glass {
  std::string name;  // as the user wrote it, may be empty
  std::variant<ConstantIndex, AbbeGlass, Sellmeier> dispersion;
  friend bool operator==(const Glass&, const Glass&) = default;
};

[[nodiscard]] inline Glass air() { return {"air", ConstantIndex{1.0}}; }
[[nodiscard]] double refractive_index(const Glass& glass, double lambda_nm);
[[nodiscard]] bool is_air(const Glass& glass);

}  // namespace contrejour
