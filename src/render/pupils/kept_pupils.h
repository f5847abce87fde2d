// SPDX-License-Identifier: Apache-2.0
// The pupils that a session has searched, a section of RenderCache: a light that stays where it is has the same pupils
// in the next frame, whatever its colour, its gain and the shape of the iris.
// Thread-safety: pupils may be requested from any thread; all else from one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <tuple>
#include <vector>

#include "base/number_key.h"
#include "base/recently_used.h"
#include "contrejour/expert/iris.h"
#include "render/pupils/ghost_pupil.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal::pupils {

// The inputs of a search over the whole window (pupil_search.h) besides the lens.
struct WindowSearch {
  Ghost ghost;
  const LightSource& light;
  double lambda_nm = 0.0;
  double stop_radius_mm = 0.0;  // that of the path
  const Iris& iris;
  PupilEffort effort = PupilEffort::Finest;
  const Context* context = nullptr;  // as PupilSearch's
};

class KeptPupils {
 public:
  // The properties of a lens that the pupils of its ghosts depend on: of the iris the radius, of coatings nothing
  // (what they reflect changes no ray, but they are compared with the surfaces).
  struct Key {
    std::vector<SurfaceState> surfaces;
    int stop_index = 0;
    double stop_radius_mm = 0.0, sensor_z_mm = 0.0, design_wavelength_nm = 0.0;
    int grating_orders = 0;  // of the sensor
    double grating_pitch_mm = 0.0;
    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const LensState& lens);

  explicit KeptPupils(const Key& /*key*/) : pupils_(kMaxBytes) {}

  // The result of the function of this name: that of an earlier frame, whose counts of rays are 0, or a new one.
  // request: of a lens with this section's key.
  [[nodiscard]] GhostPupil search_ghost_pupil(const PupilRequest& request);
  [[nodiscard]] GhostPupil fit_ghost_pupil(const PupilRequest& request, GhostPupil searched);
  [[nodiscard]] GhostPupil find_ghost_pupil(const PupilRequest& request);
  // boxes: those of the same request with the stop's own radius.
  [[nodiscard]] GhostPupil refit_ghost_pupil(const PupilRequest& request, std::vector<Rectangle> boxes);

  // The pupil over a window, that of an earlier frame or of `search`. Those of an iris that is a picture are not kept,
  // nor is one that was searched while the caller cancelled.
  [[nodiscard]] Pupil find_window_pupil(const WindowSearch& of, const std::function<Pupil()>& search);

  void next_frame() { pupils_.next_frame(); }
  [[nodiscard]] std::size_t memory_bytes() const { return pupils_.bytes(); }

 private:
  static constexpr std::size_t kMaxBytes = std::size_t{32} << 20U;  // 100 000 pupils
  static constexpr std::size_t kEntryBytes = 256;  // about what a key and the map's node take

  enum class Stage : std::uint8_t { Searched, Fitted, Refitted, OverWindow };
  using PupilKey = std::tuple<Stage, Ghost, NumberKey>;  // of the light, the wavelengths and the stop
  [[nodiscard]] static PupilKey key_of(const PupilRequest& request, Stage stage);
  [[nodiscard]] static PupilKey key_of(const WindowSearch& of);
  // The kept pupil, or that of make(), which is then kept.
  template <class Make>
  [[nodiscard]] GhostPupil get(const PupilRequest& request, Stage stage, const Make& make);

  RecentlyUsed<PupilKey, std::vector<Rectangle>> pupils_;  // of a search over a window: the box, then sensor_mm
};

}  // namespace contrejour::inline internal::pupils
