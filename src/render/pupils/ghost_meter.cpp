// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/ghost.h"
#include "ghosts/light_frame.h"
#include "render/pupils/direct_meter.h"
#include "render/pupils/ghost_light.h"

namespace contrejour {

struct GhostMeter::State {
  LensState lens;
  double lambda_nm;
  TablesByWavelength tables;
  StepsByWavelength steps;
  IrisShape iris;

  State(LensState of, double at_nm)
      : lens(std::move(of)), lambda_nm(at_nm), tables(lens), steps(lens, tables), iris(lens.iris) {}
};

GhostMeter::GhostMeter(LensState lens, double lambda_nm) {
  if (check_lens(lens) && is_wavelength(lambda_nm)) state_ = std::make_unique<const State>(std::move(lens), lambda_nm);
}
GhostMeter::~GhostMeter() = default;
GhostMeter::GhostMeter(GhostMeter&&) noexcept = default;
GhostMeter& GhostMeter::operator=(GhostMeter&&) noexcept = default;

double GhostMeter::direct_flux(const LightSource& light) const {
  if (!state_ || !check_source(state_->lens, light)) return 0.0;
  return DirectMeter(state_->lens, light).flux_mm2(state_->tables.at(state_->lambda_nm));
}

GhostMeasure GhostMeter::measure(Ghost ghost, const LightSource& light, double pixel_mm) const {
  if (!state_ || !check_source(state_->lens, light) || !has_surfaces_of(state_->lens, ghost)) return {};
  const double lambda_nm = state_->lambda_nm;
  const EntranceWindow window = LightWindows(state_->lens, light).of(has_axial_symmetry(state_->lens, ghost));
  const pupils::PupilRequest request{state_->steps, ghost, light, window, {&lambda_nm, 1}};
  const pupils::Footprint footprint = footprint_of(request, find_ghost_pupil(request), lambda_nm, state_->iris);
  GhostMeasure measure = footprint.measure();
  measure.peak_per_mm2 = footprint.peak_per_mm2(pixel_mm);
  return measure;
}

}  // namespace contrejour
