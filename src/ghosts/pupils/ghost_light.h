// What one ghost of one light does on the sensor: integrals over its pupil, box by box, from few exact rays and the
// polynomials through them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "contrejour/ghost.h"
#include "ghosts/pupils/ghost_pupil.h"
#include "ghosts/pupils/open_mesh.h"

namespace contrejour::pupils {

// Fine: fluxes to 1e-3, edges and footprints to some thousandths of their size. Rough: fluxes to 1e-2.
enum class MeshCare { Rough, Fine };

// Calls visit(sheet, mesh, is_mirrored) for parts that together are all of a ghost's pupil at one wavelength, which
// the tracer's path has. A sheet that is mirrored is the mirror image of the rays that were traced last.
using VisitMesh = std::function<void(const RaySheet& sheet, const OpenMesh& mesh, bool is_mirrored)>;
void for_each_mesh(SheetTracer& tracer, std::span<const Rectangle> boxes, const LightFrame& light,
                   const IrisShape& iris, MeshCare care, const VisitMesh& visit);

// All of a ghost's figures at one of the request's wavelengths. pixel_mm: side of the square that peaks are means over.
[[nodiscard]] GhostMeasure measure_ghost(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm,
                                         const IrisShape& iris, double pixel_mm);

// Fluxes at each of the request's wavelengths, mm^2 at E0 = 1: where light gets through is told by the middle one, what
// it carries is traced at each. Good to some hundredths of each other.
[[nodiscard]] std::vector<double> rough_fluxes(const PupilRequest& request, const GhostPupil& pupil,
                                               const IrisShape& iris);

}  // namespace contrejour::pupils
