// SPDX-License-Identifier: Apache-2.0
#include "render/device/kept_patterns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace contrejour::inline internal {
namespace {

using stop_patterns::EdgePattern;
using stop_patterns::EdgeProfile;
using stop_patterns::PatternTexture;

// The deviation from 1 that still counts as uniform.
constexpr double kUniformWithin = 0.002;
constexpr double kUniformInGrid = 1e-3;  // the same for grids of rays (kUniform of bundle/cell_raster.cpp)
// The integrated squared difference of a straight edge's profile from the sharp one is this at least (kEdgeError of
// patterned_items.cpp), in units of the profile.
constexpr double kEdgeDifference = 0.3;
// The length of the iris's outline over its area, as a circle's.
constexpr double kOutlineByArea = 2.0;

constexpr double position_of(std::size_t k) {
  return DevicePatterns::kFirstPosition + static_cast<double>(k) / DevicePatterns::kPositionsAUnit;
}
constexpr std::size_t kPositions = static_cast<std::size_t>(
    (DevicePatterns::kLastPosition - DevicePatterns::kFirstPosition) * DevicePatterns::kPositionsAUnit + 1.0);

std::vector<float> edge_table(const EdgeProfile& profile) {
  std::vector<float> table;
  table.reserve(2 * kPositions);
  for (std::size_t k = 0; k < kPositions; ++k) {
    const double t = position_of(k), width = t - DevicePatterns::kFirstPosition;
    const double integral = k == 0 ? 0.0 : width * profile.at(t - 0.5 * width, width);
    table.push_back(static_cast<float>(profile.at(t, 0.0)));
    table.push_back(static_cast<float>(integral - std::max(t, 0.0)));
  }
  return table;
}

// The profile's squared slope, integrated over its positions.
double squared_slope(const std::vector<float>& table) {
  double sum = 0.0;
  for (std::size_t k = 2; k < table.size(); k += 2) {
    const double step = static_cast<double>(table[k]) - table[k - 2];
    sum += step * step * DevicePatterns::kPositionsAUnit;
  }
  return sum;
}

// The levels of an image pyramid one after the other: DownsampledPicture.
std::vector<float> pyramid_table(std::vector<float> table, std::size_t finest_side) {
  std::size_t fine = 0;
  for (auto side = finest_side; side % 2 == 0 && side > 2; side /= 2) {
    const auto at = [&](std::size_t x, std::size_t y) { return table[fine + y * side + x]; };
    const std::size_t half = side / 2, next = fine + side * side;
    for (std::size_t y = 0; y < half; ++y)
      for (std::size_t x = 0; x < half; ++x)
        table.push_back(0.25F *
                        (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1)));
    fine = next;
  }
  return table;
}

std::vector<float> texture_table(const PatternTexture& texture) {
  return pyramid_table({texture.samples().begin(), texture.samples().end()}, static_cast<std::size_t>(texture.side()));
}

constexpr std::size_t kPictureSide = 1024;
constexpr double kPictureExtent = 1.0625;  // stop radii: the rim, and what pixels see beyond it

constexpr double kPitch = 2.0 * kPictureExtent / kPictureSide;

Vec2 middle_of_sample(std::size_t k) {
  const double column = static_cast<double>(k % kPictureSide) + 0.5, row = static_cast<double>(k / kPictureSide) + 0.5;
  return {column * kPitch - kPictureExtent, kPictureExtent - row * kPitch};
}

// A table that begins with the picture's coordinates of the stop's x axis.
std::vector<float> turned_table(const IrisShape& iris) {
  const Vec2 right = iris.picture_from_stop({1.0, 0.0});
  return {static_cast<float>(right.x), static_cast<float>(right.y)};
}

// Appends the distances of a picture as the iris at the samples of its field, rows from the lowest, of which the first
// and the last lie half a sample beyond the picture.
void add_field(const IrisShape& iris, DevicePatterns& to) {
  const IrisField& field = *iris.picture();
  const int side = field.samples() + 2;
  const double scale = 0.5 * field.samples();
  std::vector<float> table = turned_table(iris);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      table.push_back(static_cast<float>(field.distance({(column - 0.5) / scale - 1.0, (row - 0.5) / scale - 1.0})));
  to.patterns.push_back(
      {.table = static_cast<std::uint32_t>(to.tables.size()), .side = static_cast<std::uint32_t>(side)});
  to.tables.push_back(std::move(table));
}

// Appends the half-tones of a picture as the iris, in its own orientation, rows from the lowest. Their number a side is
// rounded up, so that it can be halved.
void add_half_tones(const IrisShape& iris, DevicePatterns& to) {
  constexpr std::size_t kMultiple = 64;
  const IrisField& field = *iris.picture();
  const auto side = static_cast<std::size_t>(field.samples());
  const std::size_t padded = (side + kMultiple - 1) / kMultiple * kMultiple;
  std::vector<float> samples(padded * padded, 0.0F);
  const double pitch = 2.0 / static_cast<double>(side);
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column)
      samples[row * padded + column] = static_cast<float>(field.transmittance(
          {(static_cast<double>(column) + 0.5) * pitch - 1.0, (static_cast<double>(row) + 0.5) * pitch - 1.0}));
  std::vector<float> table = turned_table(iris);
  const std::vector<float> pyramid = pyramid_table(std::move(samples), padded);
  table.insert(table.end(), pyramid.begin(), pyramid.end());
  to.patterns.push_back({.table = static_cast<std::uint32_t>(to.tables.size()),
                         .side = static_cast<std::uint32_t>(padded),
                         .scale = static_cast<float>(side)});
  to.tables.push_back(std::move(table));
}

// Appends a picture as the iris. A sample of what it transmits is the mean over the sample's square.
void add_picture(const IrisShape& iris, DevicePatterns& to) {
  to.picture = static_cast<std::uint32_t>(to.patterns.size());
  std::vector<float> distances(kPictureSide * kPictureSide), transmittances(distances.size());
  for (std::size_t k = 0; k < distances.size(); ++k) {
    const double distance = iris.picture_distance(middle_of_sample(k));
    distances[k] = static_cast<float>(distance);
    const double open = std::clamp(0.5 - distance / kPitch, 0.0, 1.0);
    const double tone = iris.has_half_tones() ? iris.picture_transmittance(middle_of_sample(k), kPitch) : 1.0;
    transmittances[k] = static_cast<float>(open * tone);
  }
  double slopes = 0.0;
  for (std::size_t k = kPictureSide; k < distances.size(); ++k) {
    slopes += std::pow(transmittances[k] - transmittances[k - 1], 2.0) +
              std::pow(transmittances[k] - transmittances[k - kPictureSide], 2.0);
  }
  DevicePattern one;
  one.side = kPictureSide;
  one.scale = one.outer_radius = static_cast<float>(kPictureExtent);
  one.roughness = static_cast<float>(slopes / std::numbers::pi);
  for (std::vector<float>* samples : {&transmittances, &distances}) {
    one.table = static_cast<std::uint32_t>(to.tables.size());
    to.tables.push_back(pyramid_table(std::move(*samples), kPictureSide));
    to.patterns.push_back(one);
  }
  add_field(iris, to);
  if (iris.has_half_tones()) add_half_tones(iris, to);
}

// The fringes of the iris's edges, also where a picture's half-tones dim them; null: there are none.
const EdgePattern* fringes_of(const StopPattern& pattern) {
  return pattern.toned() != nullptr ? pattern.toned()->edges() : pattern.edges();
}

DevicePattern edge_pattern(const EdgePattern& edges, const std::vector<float>& table) {
  DevicePattern out;
  out.outer_radius = static_cast<float>(edges.outer_radius());
  out.scale = static_cast<float>(1.0 / edges.fringe_unit());
  out.level_from = static_cast<float>(edges.profile().level_above(kUniformWithin));
  out.uniform_from = static_cast<float>(edges.profile().level_above(kUniformInGrid));
  out.roughness = static_cast<float>(squared_slope(table));
  out.difference = static_cast<float>(kOutlineByArea * edges.fringe_unit() *
                                      std::max(edges.profile().squared_error({0.0, 0.0}), kEdgeDifference));
  return out;
}

// Sums over the samples of a pattern of the whole iris are relative to the area of a disc, which the iris about fills.
DevicePattern whole_pattern(const PatternTexture& texture, const IrisShape& iris) {
  DevicePattern out;
  const auto side = static_cast<std::size_t>(texture.side());
  out.side = static_cast<std::uint32_t>(side);
  out.outer_radius = out.scale = static_cast<float>(texture.extent());
  const double pitch = 2.0 * texture.extent() / static_cast<double>(side);
  std::vector<float> x(side), y(side), distances(side);
  for (std::size_t k = 0; k < side; ++k) x[k] = static_cast<float>((static_cast<double>(k) + 0.5) * pitch - out.scale);
  double slopes = 0.0, differences = 0.0;
  const auto samples = texture.samples();
  for (std::size_t row = 0; row < side; ++row) {
    std::ranges::fill(y, out.scale - static_cast<float>((static_cast<double>(row) + 0.5) * pitch));
    iris.distances(x.data(), y.data(), side, distances.data());
    for (std::size_t column = 0; column < side; ++column) {
      const double here = samples[row * side + column];
      const double off = here - (distances[column] <= 0.0F ? 1.0 : 0.0);
      differences += off * off * pitch * pitch;
      if (row + 1 == side || column + 1 == side) continue;
      const double across = samples[row * side + column + 1] - here, down = samples[(row + 1) * side + column] - here;
      slopes += across * across + down * down;  // over the pitch squared, times the area of a sample
    }
  }
  out.roughness = static_cast<float>(slopes / std::numbers::pi);
  out.difference = static_cast<float>(differences / std::numbers::pi);
  return out;
}

std::shared_ptr<const DevicePatterns> device_patterns(const std::vector<std::shared_ptr<const StopPattern>>& wanted,
                                                      const IrisShape& iris) {
  auto made = std::make_shared<DevicePatterns>();
  std::map<const void*, std::uint32_t> table_at;
  std::map<const PatternTexture*, DevicePattern> whole;  // that were measured
  for (const std::shared_ptr<const StopPattern>& pattern : wanted) {
    const EdgePattern* const edges = fringes_of(*pattern);
    const PatternTexture* const texture = pattern->texture();
    if (edges == nullptr && texture == nullptr) {  // half-tones within a sharp outline
      made->owners.push_back(pattern);
      made->patterns.push_back({.outer_radius = static_cast<float>(pattern->outer_radius()), .scale = 0.0F});
      continue;
    }
    const void* const from = edges != nullptr ? static_cast<const void*>(&edges->profile()) : texture;
    const auto [at, is_new] = table_at.try_emplace(from, static_cast<std::uint32_t>(made->tables.size()));
    if (is_new) {
      made->owners.push_back(pattern);
      made->tables.push_back(edges != nullptr ? edge_table(edges->profile()) : texture_table(*texture));
      if (edges == nullptr) whole.emplace(texture, whole_pattern(*texture, iris));
    }
    DevicePattern one = edges != nullptr ? edge_pattern(*edges, made->tables[at->second]) : whole.at(texture);
    one.table = at->second;
    made->patterns.push_back(one);
  }
  if (iris.is_picture()) add_picture(iris, *made);
  return made;
}

}  // namespace

KeptPatterns::Identity KeptPatterns::identity_of(const StopPattern& pattern) {
  if (const EdgePattern* const edges = fringes_of(pattern)) return {&edges->profile(), edges->fringe_unit()};
  return {pattern.texture(), 0.0};
}

std::shared_ptr<const DevicePatterns> KeptPatterns::get(const std::vector<std::shared_ptr<const StopPattern>>& wanted,
                                                        const Iris& iris) {
  if (wanted.empty() && !iris.field) return nullptr;
  std::vector<Identity> identities;
  identities.reserve(wanted.size());
  for (const std::shared_ptr<const StopPattern>& pattern : wanted) identities.push_back(identity_of(*pattern));
  if (!patterns_ || identities != identities_ || iris != iris_) patterns_ = device_patterns(wanted, IrisShape(iris));
  identities_ = std::move(identities);
  iris_ = iris;
  return patterns_;
}

std::size_t KeptPatterns::memory_bytes() const {
  std::size_t bytes = 0;
  if (patterns_)
    for (const std::vector<float>& table : patterns_->tables) bytes += table.size() * sizeof(float);
  return bytes;
}

}  // namespace contrejour::inline internal
