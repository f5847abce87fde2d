// SPDX-License-Identifier: Apache-2.0
// From a frame's settings to its flare, by the library alone: nothing here knows of a host. An engine keeps from frame
// to frame what frames have in common: the lens, the look and the file of lights as read, and the renderer.
// Errors: those of the library. Thread-safety: one thread at a time uses an engine; two engines share nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contrejour/apply.h"
#include "contrejour/expert/animation.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/preset.h"
#include "contrejour/renderer.h"

namespace contrejour::openfx {

struct FlareRequest {
  params::Values own;  // what the user set here, without lights
  std::vector<std::pair<std::string, std::string>> lights;  // parameters "light" and "light-at", with their texts
  std::string look, lens;  // bundled names or files; empty: none, and the look's lens
  std::string lights_file;  // empty: none
  double time = 0.0;  // for the file of lights: a frame's number
  PixelWindow region;  // the pixels of the flare, rows from the top
  PixelWindow frame;  // what the sensor sees, in the same coordinates
  PixelWindow unscaled_frame;  // the same frame without the host's render scale, in which lights have their brightness
  double pixel_aspect = 1.0;
  bool is_draft = false;
  bool shows_detected_lights = false;  // in place of their flare
  bool is_part_of_frame = false;  // other parts of the same frame will be asked for: keep it
  int threads = 0;  // at most, where the values set none; 0: all cores
  Image source;  // of the region, scene-linear; empty: there is none, or its lights are not wanted
};

class FlareEngine {
 public:
  // The flare of the request's region; null if there is none.
  [[nodiscard]] Result<std::shared_ptr<const Image>> render(FlareRequest request, const Context& context);

 private:
  // A value read from a file, or a bundled one, until the file changes.
  template <class T>
  struct Kept {
    std::string name;
    std::filesystem::file_time_type written;
    std::optional<T> value;
  };
  template <class T, class Read>
  Result<const T*> keep(Kept<T>& kept, const std::string& name, const Read& read);

  struct FrameValues {
    params::Values all;  // with what the look and the file of lights say, without lights
    params::Values with_lights;
    std::string lens;
  };
  [[nodiscard]] Result<FrameValues> values_of(const FlareRequest& request);
  // The lens, or the measured flare, whose ideal lens is then lens_.
  [[nodiscard]] Result<void> set_source(const FlareRequest& request, const FrameValues& values);
  [[nodiscard]] Result<void> set_lens(const FrameValues& values);
  [[nodiscard]] Result<void> set_method(const params::Values& values, bool is_draft);
  [[nodiscard]] Result<FlarePlan> plan(FlareRequest& request, const FrameValues& values, Picture& picture) const;
  [[nodiscard]] Result<std::vector<Light>> given_lights(const FlareRequest& request, const FrameValues& values,
                                                        const FlarePlan& plan) const;
  [[nodiscard]] Result<Flare> render_plan(const FlareRequest& request, const FrameValues& values, const FlarePlan& plan,
                                          const Context& context);
  [[nodiscard]] Result<std::shared_ptr<const Image>> draw(FlareRequest& request, const FrameValues& values,
                                                          const Context& context);

  Kept<params::Preset> look_;
  Kept<Prescription> prescription_;
  Kept<MeasuredFlare> flare_;
  Kept<Animation> animation_;
  std::string lens_key_;
  LensState lens_;
  const MeasuredFlare* measured_ = nullptr;  // of flare_, where that is the frame's source
  std::optional<Renderer> renderer_;
  std::string frame_key_;  // of frame_
  std::shared_ptr<const Image> frame_;
};

}  // namespace contrejour::openfx
