// SPDX-License-Identifier: Apache-2.0
// The transmittance near the edges of an iris that have fringes, from tables by distance.
#if defined(CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "render/adaptive/tiles/channel_vector-inl.h"
#include "render/adaptive/tiles/tile_rows-inl.h"
#include "render/polygons/pattern_atlas.h"
#include "render/polygons/polygon_list.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

static_assert(std::tuple_size_v<Channels> == kVectorChannels);

// Indices into a table of fringes along rows, by distance from an edge: from a bound, or from a picture's outline.
class EdgePositions {
 public:
  EdgePositions() = default;
  EdgePositions(const EdgeTable& table, const IrisBound& bound, const PatternMap& map) {
    const double scale = table.per_step;
    if (bound.straight()) {
      kind_ = Kind::Straight;
      x_ = RowForm(map.form(bound.normal * -scale, (table.dark_beyond + bound.apothem) * scale));
      return;
    }
    kind_ = Kind::Curved;
    x_ = RowForm(map.form({scale, 0.0}, -bound.centre.x * scale));
    y_ = RowForm(map.form({0.0, scale}, -bound.centre.y * scale));
    edge_ = static_cast<float>((table.dark_beyond + bound.radius) * scale);
  }
  EdgePositions(const EdgeTable& table, const OutlineTable& outline, const PatternMap& map)
      : kind_(Kind::Picture), x_(map.form({1.0, 0.0}, 0.0)), y_(map.form({0.0, 1.0}, 0.0)), table_(&table),
        outline_(&outline) {}

  HWY_INLINE void set_row(const PixelRow& row) {
    x_.set_row(row);
    if (kind_ != Kind::Straight) y_.set_row(row);
  }
  // count: the number of pixels that are needed.
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(hn::Vec<FloatTag> pixel_x, int count) const {
    return kind_ == Kind::Picture ? of_picture(x_.at(pixel_x), y_.at(pixel_x), count) : along().at(pixel_x);
  }
  // The coefficients along a row in vectors; not for a picture.
  struct Along {
    bool straight;
    RowForm::Along x, y;
    hn::Vec<FloatTag> edge;
    [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(hn::Vec<FloatTag> pixel_x) const {
      const auto from_x = x.at(pixel_x);
      if (straight) return from_x;
      const auto from_y = y.at(pixel_x);
      return hn::Sub(edge, hn::Sqrt(hn::MulAdd(from_x, from_x, hn::Mul(from_y, from_y))));
    }
  };
  [[nodiscard]] HWY_INLINE Along along() const {
    return {kind_ == Kind::Straight, x_.along(), y_.along(), hn::Set(FloatTag(), edge_)};
  }
  // largest: the last index of the table.
  [[nodiscard]] HWY_INLINE UniformGroups uniform(const PixelRow& row, float largest) const {
    if (kind_ == Kind::Picture) return {};
    const FloatTag d;
    const float across = x_.half_group(row), down = kind_ == Kind::Straight ? 0.0F : y_.half_group(row);
    const float extent = across + down;
    const auto level = hn::Set(d, largest + extent), dark = hn::Set(d, -extent);
    UniformGroups out;
    out.level = groups_that(row, [&](hn::Vec<FloatTag> x) HWY_ATTR { return hn::Ge(at(x, 0), level); });
    out.dark = groups_that(row, [&](hn::Vec<FloatTag> x) HWY_ATTR { return hn::Le(at(x, 0), dark); });
    return out;
  }

 private:
  enum class Kind : std::uint8_t { Straight, Curved, Picture };

  [[nodiscard]] hn::Vec<FloatTag> of_picture(hn::Vec<FloatTag> x, hn::Vec<FloatTag> y, int count) const {
    const FloatTag d;
    HWY_ALIGN float at_x[kGroup], at_y[kGroup], position[kGroup] = {};
    hn::Store(x, d, at_x);
    hn::Store(y, d, at_y);
    for (int k = 0; k < std::min(count, static_cast<int>(hn::Lanes(d))); ++k) {
      const double distance = outline_->distance({static_cast<double>(at_x[k]), static_cast<double>(at_y[k])});
      position[k] = static_cast<float>((table_->dark_beyond - distance) * table_->per_step);
    }
    return hn::Load(d, position);
  }

  Kind kind_ = Kind::Straight;
  RowForm x_, y_;  // of a straight edge, x is the index; of a curved one they are offsets from its centre
  float edge_ = 0;  // index at a curved edge's centre
  const EdgeTable* table_ = nullptr;
  const OutlineTable* outline_ = nullptr;
};

// Fringes are looked up in these: the table, and the bounds or the outline from which distances are measured.
struct FringeInput {
  const PolygonList& list;
  const EdgeTable& table;
  std::span<const std::uint16_t> active;  // bounds
  const OutlineTable* outline;
  const PatternMap& map;

  [[nodiscard]] std::size_t edges() const { return table.of_outline ? 1 : active.size(); }
  [[nodiscard]] EdgePositions edge(std::size_t k) const {
    return table.of_outline ? EdgePositions(table, *outline, map) : EdgePositions(table, list.bounds[active[k]], map);
  }
  [[nodiscard]] float largest() const { return static_cast<float>(table.count - 1); }  // last index of the table
};

// Several edges: the product of their factors.
class Edges {
 public:
  explicit Edges(const FringeInput& from) : largest_(from.largest()) {
    const std::size_t count = from.edges();
    if (count > few_.size()) many_.resize(count);
    all_ = {many_.empty() ? few_.data() : many_.data(), count};
    for (std::size_t k = 0; k < count; ++k) all_[k] = from.edge(k);
  }
  Edges(const Edges&) = delete;
  Edges& operator=(const Edges&) = delete;
  ~Edges() = default;

  HWY_INLINE void set_row(const PixelRow& row) {
    for (EdgePositions& edge : all_) edge.set_row(row);
  }
  [[nodiscard]] float largest() const { return largest_; }

  [[nodiscard]] HWY_INLINE UniformGroups uniform(const PixelRow& row) const {
    UniformGroups out{0, ~Groups{0}};
    for (const EdgePositions& edge : all_) {
      const UniformGroups one = edge.uniform(row, largest_);
      out.dark |= one.dark;
      out.level &= one.level;
    }
    return out;
  }
  // Calls `multiply(position)` for each edge, with the indices of the pixels from k on.
  template <class Multiply>
  HWY_INLINE void lookup(const PixelRow& row, int k, const Multiply& multiply) const {
    const auto x = row.x(k);
    for (const EdgePositions& edge : all_) multiply(edge.at(x, row.count - k));
  }

 private:
  float largest_;  // last index of the table
  std::array<EdgePositions, 4> few_;
  std::vector<EdgePositions> many_;
  std::span<EdgePositions> all_;
};

// Fringes in three channels, for some pixels at a time.
class Fringes {
 public:
  static constexpr bool kMonochrome = false;
  explicit Fringes(const FringeInput& from) : edges_(from), entries_(from.list.edge_factors[from.table.first].data()) {}

  HWY_INLINE void set_row(const PixelRow& row) { edges_.set_row(row); }
  [[nodiscard]] HWY_INLINE UniformGroups uniform(const PixelRow& row) const { return edges_.uniform(row); }

  // The factors of a vector of pixels, from k on.
  class Transmitted {
   public:
    HWY_INLINE Transmitted(const Fringes& all, const PixelRow& row, int k) : first_(k) {
      for (std::size_t j = 0; j < kLanes; ++j) ChannelVector::all(1.0F).store(factors_ + kVectorChannels * j);
      all.edges_.lookup(row, k, [&](hn::Vec<FloatTag> position) HWY_ATTR { multiply(all, position); });
    }
    [[nodiscard]] HWY_INLINE ChannelVector transmitted(int k) const {
      return ChannelVector::load(factors_ + kVectorChannels * static_cast<std::size_t>(k - first_));
    }

   private:
    static constexpr std::size_t kLanes = hn::MaxLanes(FloatTag());

    HWY_INLINE void multiply(const Fringes& all, hn::Vec<FloatTag> position) {
      const FloatTag d;
      if (hn::AllTrue(d, hn::Ge(position, hn::Set(d, all.edges_.largest())))) return;
      const TablePositions at = TableEnd(all.edges_.largest()).positions(position);
      HWY_ALIGN std::int32_t whole[kLanes];
      HWY_ALIGN float fraction[kLanes];
      hn::Store(at.whole, IntTag(), whole);
      hn::Store(at.fraction, d, fraction);
      for (std::size_t j = 0; j < kLanes; ++j) {
        const float* const entry = all.entries_ + kVectorChannels * static_cast<std::size_t>(whole[j]);
        const ChannelVector factor = interpolate(
            ChannelVector::load(entry), ChannelVector::load(entry + kVectorChannels), ChannelVector::all(fraction[j]));
        (ChannelVector::load(factors_ + kVectorChannels * j) * factor).store(factors_ + kVectorChannels * j);
      }
    }

    int first_;
    HWY_ALIGN float factors_[kVectorChannels * kLanes];
  };
  struct Row {
    const Fringes& all;
    PixelRow row;
    [[nodiscard]] HWY_INLINE Transmitted vector(int k) const { return {all, row, k}; }
  };
  [[nodiscard]] HWY_INLINE Row lookup(const PixelRow& row, Groups /*wanted*/) const { return {*this, row}; }

 private:
  Edges edges_;
  const float* entries_;
};

// The transmittance by index, with one value for all channels.
class MonochromeTable {
 public:
  explicit MonochromeTable(const FringeInput& from)
      : steps_(from.list.edge_steps.data() + from.table.first), end_(from.largest()) {}

  [[nodiscard]] HWY_INLINE TablePositions positions(hn::Vec<FloatTag> position) const {
    return end_.positions_to_end(position);
  }
  // Interpolates: `fraction` is the fraction within each step.
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(const std::int32_t* step, hn::Vec<FloatTag> fraction) const {
    static_assert(sizeof(EdgeStep) == 8);
    const HalfWords<float> steps(steps_, step);
    return hn::MulAdd(fraction, steps.second, steps.first);
  }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(hn::Vec<FloatTag> position) const {
    const TablePositions at_position = positions(position);
    HWY_ALIGN std::int32_t step[hn::MaxLanes(IntTag())];
    hn::Store(at_position.whole, IntTag(), step);
    return at(step, at_position.fraction);
  }

 private:
  const EdgeStep* steps_;
  TableEnd end_;
};

// One edge of the iris, with one value for all channels.
class MonochromeFringe {
 public:
  static constexpr bool kMonochrome = true;
  explicit MonochromeFringe(const FringeInput& from) : table_(from), largest_(from.largest()), edge_(from.edge(0)) {}

  HWY_INLINE void set_row(const PixelRow& row) { edge_.set_row(row); }
  [[nodiscard]] HWY_INLINE UniformGroups uniform(const PixelRow& row) const { return edge_.uniform(row, largest_); }

  // Computes all indices first, so that look-ups wait for nothing but the table.
  class Row {
   public:
    HWY_INLINE Row(const MonochromeFringe& all, const PixelRow& row, Groups wanted) : table_(all.table_) {
      const EdgePositions::Along edge = all.edge_.along();
      for (; wanted != 0; wanted &= wanted - 1) {
        const int first = kGroup * std::countr_zero(wanted);
        for (int k = first; k < first + kGroup; k += static_cast<int>(hn::MaxLanes(FloatTag()))) {
          const TablePositions at = table_.positions(edge.at(row.x(k)));
          hn::Store(at.whole, IntTag(), step_ + k);
          hn::Store(at.fraction, FloatTag(), fraction_ + k);
        }
      }
    }
    [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> transmitted(int k) const {
      return table_.at(step_ + k, hn::Load(FloatTag(), fraction_ + k));
    }

   private:
    MonochromeTable table_;
    HWY_ALIGN std::int32_t step_[kRowCapacity];
    HWY_ALIGN float fraction_[kRowCapacity];
  };
  [[nodiscard]] HWY_INLINE Row lookup(const PixelRow& row, Groups wanted) const { return {*this, row, wanted}; }

 private:
  MonochromeTable table_;
  float largest_;
  EdgePositions edge_;
};

// Several edges, with one value for all channels.
class MonochromeFringes {
 public:
  static constexpr bool kMonochrome = true;
  explicit MonochromeFringes(const FringeInput& from) : edges_(from), table_(from) {}

  HWY_INLINE void set_row(const PixelRow& row) { edges_.set_row(row); }
  [[nodiscard]] HWY_INLINE UniformGroups uniform(const PixelRow& row) const { return edges_.uniform(row); }

  struct Row {
    const MonochromeFringes& all;
    PixelRow row;
    [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> transmitted(int k) const {
      auto transmitted = hn::Set(FloatTag(), 1.0F);
      all.edges_.lookup(row, k, [&](hn::Vec<FloatTag> position) HWY_ATTR {
        transmitted = hn::Mul(transmitted, all.table_.at(position));
      });
      return transmitted;
    }
  };
  [[nodiscard]] HWY_INLINE Row lookup(const PixelRow& row, Groups /*wanted*/) const { return {*this, row}; }

 private:
  Edges edges_;
  MonochromeTable table_;
};

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
