// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "base/tasks.h"
#include "contrejour/expert/published_pictures.h"
#include "polynomial/published/light_polynomial.h"
#include "polynomial/published/splat.h"

namespace contrejour::published {

Result<Image> draw_two_lenses(const TwoLensesPicture& picture, const Context& context) {
  constexpr int kMost = 16384;
  if (picture.size < 1 || picture.size > kMost || picture.points < 1 || picture.points > kMost ||
      !(picture.half_size > 0.0))
    return failure(ErrorCode::InvalidArgument, "pictures need a size and a number of points from 1 to 16384");
  if ((picture.x == nullptr) != (picture.y == nullptr))
    return failure(ErrorCode::InvalidArgument, "a picture needs the polynomials of x and y, or neither");
  std::optional<polynomial::LightPolynomial> x, y;
  if (picture.x != nullptr) x.emplace(*picture.x, picture.light), y.emplace(*picture.y, picture.light);
  const auto ray = [&](Vec2 unit) -> std::optional<polynomial::SplatRay> {
    const Vec2 at{2.0 * unit.x - 1.0, 2.0 * unit.y - 1.0};
    if (x) return polynomial::SplatRay{{x->at(at), y->at(at)}};
    const TwoLensesRay traced = trace(picture.system, picture.ghost, {picture.light.x, picture.light.y, at.x, at.y});
    if (!traced.arrives) return std::nullopt;
    return polynomial::SplatRay{traced.sensor};
  };
  polynomial::SplatTarget target(picture.size, picture.size, {picture.half_size, picture.half_size});
  if (!polynomial::splat(target, ray, {.side = picture.points}, 1.0, context)) return interrupted();
  return target.image();
}

}  // namespace contrejour::published
