#include "render/adaptive/screened_items.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/tasks.h"
#include "render/screens/iris_screens.h"

namespace contrejour::adaptive {
namespace {

// Of the frame's squared error: what ghosts that stay sharp may make, and small ripples within the others.
constexpr double kSharpShare = 0.4, kRippleShare = 0.25;
constexpr double kPeaks = 16.0;  // levels over the peak from which on errors count as relative ones (cell_painter.cpp)
// A straight edge's profile less the sharp one, squared and summed, is so many of an edge's units.
constexpr double kEdgeError = 0.3;
constexpr double kOutline = 1.5;  // over a disc's of the same area

// What an item's fringes differ from its sharp rim, squared, over its pixels.
double fringe_error(const ItemSize& size, double peak, double fresnel_number) {
  const double seen = size.level / (1.0 + size.level / (kPeaks * peak));
  // unit = R / sqrt(2 F), the outline 2 pi R, pi R^2 the area.
  return kEdgeError * kOutline * seen * seen * 2.0 * size.area_px / std::sqrt(2.0 * std::max(fresnel_number, 0.5));
}

// Of some items' errors, by rising error: those beyond what the smallest may make together.
std::vector<std::size_t> worth_drawing(std::vector<std::size_t> some, const std::vector<double>& error,
                                       double allowed) {
  std::stable_sort(some.begin(), some.end(), [&](std::size_t a, std::size_t b) { return error[a] < error[b]; });
  double sum = 0.0;
  const auto first = std::find_if(some.begin(), some.end(), [&](std::size_t k) { return (sum += error[k]) > allowed; });
  some.erase(some.begin(), first);
  std::sort(some.begin(), some.end());
  return some;
}

// Screens of all passes; one whose fringes are not seen takes the next one's, a little wider. Null: none is seen.
std::shared_ptr<GhostScreens> screens_of(const Screens& screens, const Item& item) {
  auto all = std::make_shared<GhostScreens>();
  for (const PlannedPass& pass : item.light->passes) all->by_pass.push_back(screens.of(item.ghost, pass.lambda_nm, item.light->source));
  const auto seen = [](const auto& screen) { return screen != nullptr; };
  const auto any = std::find_if(all->by_pass.rbegin(), all->by_pass.rend(), seen);
  if (any == all->by_pass.rend()) return nullptr;
  auto next = *any;
  for (auto at = all->by_pass.rbegin(); at != all->by_pass.rend(); ++at) {
    if (*at == nullptr) *at = next;
    next = *at;
  }
  return all;
}

// How far fringes are drawn: as far as they make more than an error, squared and in an edge's units.
void set_range(GhostScreens& screens, double squared_error) {
  for (const auto& screen : screens.by_pass) {
    const auto* const edge = dynamic_cast<const screens::EdgeScreen*>(screen.get());
    if (edge == nullptr) {
      screens.reach = std::max(screens.reach, screen->reach());
      continue;
    }
    screens.range = edge->profile().range_for(squared_error);
    screens.reach = std::max(screens.reach, 1.0 - screens.range.dark * edge->unit());
  }
}

}  // namespace

Work screen_items(const Scene& scene, Screens& screens, std::vector<Item>& items, const std::vector<ItemSize>& sizes,
                  const FrameError& allowed, const Context& context) {
  const double squares = std::pow(allowed.error * allowed.peak, 2) * allowed.pixels;
  std::vector<std::size_t> all(items.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<double> error(items.size());
  for (const std::size_t k : all) error[k] = fringe_error(sizes[k], allowed.peak, 0.5);  // at the most
  std::vector<std::size_t> chosen = worth_drawing(all, error, 0.5 * kSharpShare * squares);
  for (const std::size_t k : chosen) {
    const auto& passes = items[k].light->passes;
    const double f = screens.fresnel_number(items[k].ghost, passes[passes.size() / 2].lambda_nm, items[k].light->source);
    error[k] = fringe_error(sizes[k], allowed.peak, f);
  }
  chosen = worth_drawing(std::move(chosen), error, 0.5 * kSharpShare * squares);

  std::vector<Screens::Wanted> wanted;
  for (const std::size_t k : chosen)
    for (const PlannedPass& pass : items[k].light->passes)
      wanted.push_back({items[k].ghost, pass.lambda_nm, pass.spread_nm, items[k].light->source});
  if (!screens.prepare(wanted, context)) return {};
  std::vector<Work> work(chosen.size());

  parallel_for(chosen.size(), context, [&](std::size_t at) {
    Item& item = items[chosen[at]];
    const auto mine = screens_of(screens, item);
    if (!mine) return;
    const double share = kRippleShare * squares / static_cast<double>(chosen.size()) / error[chosen[at]];
    set_range(*mine, kEdgeError * share);
    item.screens = mine;
    work[at] = find_boxes(scene, item);
  });
  Work sum;
  for (const Work& w : work) sum.add(w);
  return sum;
}

}  // namespace contrejour::adaptive
