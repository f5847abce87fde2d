#include "render/adaptive/band_set.h"

#include <algorithm>

namespace contrejour::adaptive {
namespace {

constexpr std::size_t kMostParts = 3;  // of one band: within it the rest would show no more

// What makes a band of the first `count` samples: the geometry of its middle and the light of all its wavelengths.
PatchBlend blend_of(const Band& band, std::span<const PlannedPass> passes, const WavelengthSamples& samples,
                    std::size_t count) {
  PatchBlend blend;
  blend.geometry = samples.factors(count, band.middle());
  if (band.last - band.first == 1) {
    blend.weight = {blend.geometry};
    blend.gain = passes[band.first].gain;
    return blend;
  }
  blend.weight.assign(3, std::vector<double>(count, 0.0));
  for (std::size_t pass = band.first; pass < band.last; ++pass) {
    const std::vector<double> factors = samples.factors(count, pass);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < count; ++k) blend.weight[c][k] += passes[pass].gain[c] * factors[k];
    }
  }
  return blend;
}

}  // namespace

BandSet::BandSet(GhostTracers& tracers, const Band& band) : tracers_(tracers), bands_{band} {
  const std::size_t passes = band.last - band.first;
  const std::size_t count = std::min(passes, kMostParts);
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t first = part * passes / count, last = (part + 1) * passes / count;
    Part one{band.first + (first + last) / 2, {}};
    for (std::size_t k = first; k < last; ++k) {
      for (std::size_t c = 0; c < 3; ++c) one.gain[c] += tracers.passes()[band.first + k].gain[c];
    }
    parts_.push_back(one);
  }
  std::swap(parts_.front(), parts_[count / 2]);  // the one that rays are traced at
  std::sort(parts_.begin() + 1, parts_.end(), [](const Part& a, const Part& b) { return a.pass < b.pass; });
  traced_ = {parts_.front().pass};
}

BandSet::BandSet(GhostTracers& tracers, const WavelengthSamples& samples, std::size_t count,
                 std::span<const Band> bands)
    : tracers_(tracers), bands_(bands.begin(), bands.end()) {
  for (std::size_t k = 0; k < count; ++k) traced_.push_back(samples[k]);
  for (const Band& band : bands) blends_.push_back(blend_of(band, tracers.passes(), samples, count));
}

std::vector<RaySheet> BandSet::trace(const Rectangle& box, int nodes, PacketPrecision precision) {
  std::vector<RaySheet> sheets;
  for (const std::size_t pass : traced_) sheets.push_back(tracers_.at(pass).trace(box, nodes, precision));
  return sheets;
}

void BandSet::add_weights(std::vector<RaySheet>& sheets, PacketPrecision precision) {
  if (!blends_.empty()) {
    for (RaySheet& sheet : sheets) add_light(sheet, sheet.transmission, {1.0, 1.0, 1.0});
    return;
  }
  RaySheet& sheet = sheets.front();
  add_light(sheet, sheet.transmission, parts_.front().gain);
  for (const Part& part : std::span(parts_).subspan(1))
    add_light(sheet, tracers_.at(part.pass).transmissions(sheet.box, sheet.nodes, precision), part.gain);
}

std::vector<Patch> BandSet::make_patches(std::span<const RaySheet> sheets, const Frame& frame) const {
  return adaptive::make_patches(sheets, tracers_.light(), frame);
}

void BandSet::band_patch(std::span<const Patch> patches, std::size_t band, Patch& out) const {
  if (blends_.empty())
    out = patches.front();
  else
    blend(patches, blends_[band], out);
}

}  // namespace contrejour::adaptive
