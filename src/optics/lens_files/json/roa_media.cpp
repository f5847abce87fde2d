// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/json/roa_media.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"

namespace contrejour::inline internal {
namespace {

constexpr double kSameIndex = 1e-4;  // at the d line; a larger difference means another glass of that name

// Makers, and the order of their catalogues' coefficients in ray-optics.
struct Maker {
  std::string_view class_name, maker;
  DispersionFormula formula;
  std::size_t coefficients;
};
constexpr Maker kMakers[] = {{"SchottGlass", "SCHOTT", DispersionFormula::Sellmeier1, 6},
                             {"OharaGlass", "OHARA", DispersionFormula::Sellmeier1, 6},
                             {"CDGMGlass", "CDGM", DispersionFormula::Schott, 6},
                             {"HoyaGlass", "HOYA", DispersionFormula::Schott, 6},
                             {"SumitaGlass", "SUMITA", DispersionFormula::Schott, 6},
                             {"HikariGlass", "HIKARI", DispersionFormula::Extended3, 9}};

// A list, or numpy's array.
std::vector<double> numbers_of(const JsonField& field) {
  const JsonField list = field["__ndarray__"].is_list() ? field["__ndarray__"] : field;
  std::vector<double> values;
  for (std::size_t k = 0; k < list.size(); ++k) values.push_back(list[k].required_number());
  return values;
}

// Sellmeier's six coefficients are B1, B2, B3, C1, C2, C3 there, and alternate here.
std::vector<double> in_our_order(std::vector<double> c, DispersionFormula formula) {
  if (formula != DispersionFormula::Sellmeier1) return c;
  return {c[0], c[3], c[1], c[4], c[2], c[5]};
}

Glass catalogue_glass(const Maker& maker, const JsonField& content, GlassFinder& finder) {
  const std::string name = content["gname"].text();
  const std::string makers[] = {std::string(maker.maker)};
  auto found = finder.find(name, makers);
  const std::vector<double> c = numbers_of(content["coefs"]);
  if (c.size() == maker.coefficients) {
    GlassData data;
    data.formula = maker.formula;
    data.coefficients = in_our_order(c, maker.formula);
    const auto own = make_glass(name, std::move(data));
    const auto index_of = [](const Result<Glass>& glass) { return refractive_index(*glass, kLineD_nm); };
    if (own && (!found || !(std::abs(index_of(found) - index_of(own)) <= kSameIndex))) return *own;
  }
  if (found) return *found;
  content["gname"].fail(found.error().message);
  return air();
}

// n at wavelengths in nm.
Glass tabulated(const JsonField& content) {
  const std::vector<double> lambda_nm = numbers_of(content["wvls"]), n = numbers_of(content["rndx"]);
  std::vector<std::pair<double, double>> rows;
  for (std::size_t k = 0; k < std::min(lambda_nm.size(), n.size()); ++k) rows.emplace_back(lambda_nm[k] / 1e3, n[k]);
  std::sort(rows.begin(), rows.end());
  GlassData data;
  data.formula = DispersionFormula::Table;
  for (const auto& [lambda_um, index] : rows) data.coefficients.insert(data.coefficients.end(), {lambda_um, index});
  const auto glass = make_glass(content["label"].text(), std::move(data));
  if (glass) return *glass;
  content["rndx"].fail(glass.error().message);
  return air();
}

Glass model_glass(const JsonField& n, const JsonField& v, std::string name) {
  const double n_d = n.required_number(), v_d = v.number_or(0.0);
  if (v_d == 0.0 || std::isinf(v_d)) return {std::move(name), ConstantIndex{n_d}};
  return {std::move(name), ModelGlass{n_d, v_d}};
}

}  // namespace

std::string class_of(const JsonField& object) {
  const JsonField type = object["__instance_type__"];
  return type.size() == 0 ? "" : type[type.size() - 1].text();
}

JsonField content_of(const JsonField& object) {
  return object["__instance_type__"].is_list() ? object["attributes"] : object;
}

Glass roa_glass(const JsonField& medium, GlassFinder& finder) {
  const std::string type = class_of(medium);
  const JsonField content = content_of(medium);
  if (type == "Air") return air();
  for (const Maker& maker : kMakers)
    if (maker.class_name == type) return catalogue_glass(maker, content, finder);
  std::string name = (content["label"].is_there() ? content["label"] : content["gname"]).text();
  if (content["wvls"].is_there() && content["rndx"].is_there()) return tabulated(content);
  if (content["n"].is_there()) return model_glass(content["n"], content["v"], std::move(name));
  if (content["nd"].is_there()) return model_glass(content["nd"], content["vd"], std::move(name));
  if (!name.empty()) {
    if (auto found = finder.find(name)) return *found;
  }
  medium.fail(fmt::format("the medium '{}' of class '{}' is not known; give its glass by maker and name, or its index",
                          shortened(name), shortened(type)),
              ErrorCode::Unsupported);
  return air();
}

}  // namespace contrejour::inline internal
