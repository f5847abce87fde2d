// SPDX-License-Identifier: Apache-2.0
// Acts as the filter of MLT's openfx module does. Source: mltframework/mlt, src/modules/openfx (mlt_openfx.c,
// filter_openfx.c, factory.c) of MLT 7.41, read for what it calls and passes; no line is taken from it. What it does
// otherwise than the standard:
// - property sets convert between numbers and text, and an index that no property has is a bad index;
// - the descriptor is the instance as well, one handle for both, and the arguments of DescribeInContext are the host's
//   properties;
// - the plug-in is loaded again for each instance, and unloaded once at the end;
// - every frame has an instance of its own, on the thread that renders it;
// - the project's size is written to a set that the plug-in cannot reach, and regions are those of the scaled picture;
// - 16-bit pixels become halves where a plug-in takes them, by cutting bits off, or else floats; results end at 1;
// - an image is its clip's property set, its rows run upwards through memory that runs downwards;
// - menus are stored by label; the second number of a pair arrives only if the pair is a point or a size;
// - no identity, no changes, no time line, no keys, never an abort.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "openfx/openfx_abi.h"
#include "test_host.h"

namespace contrejour::openfx {

// RGBA with 16 bits a sample, rows from the top, as MLT's rgba64.
struct MltImage {
  int width = 0, height = 0;
  std::vector<std::uint16_t> samples;

  MltImage(int w, int h)
      : width(w), height(h), samples(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {}
  [[nodiscard]] std::uint16_t& at(int x, int y, int c) {
    return samples[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4 +
                   static_cast<std::size_t>(c)];
  }
};

class MltHost {
 public:
  // Loads the plug-in and asks whether it is a filter that MLT can use. Errors: std::runtime_error if it is not.
  MltHost();
  // MLT unloads it once, however often it was loaded. This host makes room for another in the same process.
  ~MltHost();
  MltHost(const MltHost&) = delete;
  MltHost& operator=(const MltHost&) = delete;

  // The parameters that MLT's front ends offer to users: their kinds by name.
  struct Offered {
    std::string type, widget, fallback;
    bool is_normalised = false;  // of a point: the user drags it, and gets fractions of the picture
  };
  [[nodiscard]] std::map<std::string, Offered> offered() const;

  // One frame of the filter whose properties a user set as text. profile: the size of the whole picture, of which the
  // image may be a smaller preview. Thread-safety: safe.
  struct Profile {
    int width = 0, height = 0;
    double pixel_aspect = 1.0;
  };
  void filter(MltImage& image, const std::map<std::string, std::string>& properties, const Profile& profile,
              int position) const;
  // The depth in which the plug-in gets pixels.
  [[nodiscard]] std::string depth() const;

 private:
  [[nodiscard]] std::unique_ptr<EffectStruct> new_effect() const;
  void call(const char* action, EffectStruct& effect, PropertySetStruct* in = nullptr,
            PropertySetStruct* out = nullptr) const;

  PropertySetStruct properties_;
  HostTable table_{};
  const PluginTable* plugin_ = nullptr;
  mutable std::atomic<int> loads_ = 0;
};

}  // namespace contrejour::openfx
