// SPDX-License-Identifier: Apache-2.0
// Optics in C (C99), beside contrejour.h, whose conventions hold: glasses, coatings, lenses changed and written,
// third-order aberrations, rays in bulk, sections as shapes and as SVG. Pointers to text belong to the object they were
// asked of. Accuracy and sources: docs/physics. Thread-safety: as in contrejour.h.
#pragma once

#include "contrejour.h"

#ifdef __cplusplus
extern "C" {
#endif

// ---- Glasses

CONTREJOUR_API size_t cj_bundled_glass_count(void);
CONTREJOUR_API const char* cj_bundled_glass_name(size_t index);  // "SCHOTT N-BK7"; NULL beyond the last

typedef struct cj_glass cj_glass;
// "N-BK7" or "SCHOTT N-BK7", a code of six digits ("517642"), an index ("1.52"), n_d and Abbe number ("1.5168,64.17"),
// or "air". Errors: no such glass, naming the nearest.
CONTREJOUR_API cj_status cj_glass_find(const char* text, cj_glass** glass, cj_error* error);
CONTREJOUR_API void cj_glass_destroy(cj_glass* glass);

typedef struct cj_glass_info {
  size_t struct_size;
  const char* name;
  double n_d, v_d, v_e;  // v: Abbe numbers; not finite without dispersion
  double p_gf, d_pgf;  // partial dispersion, and its deviation from the normal line
  double first_nm, last_nm;  // where the glass's formula holds; 0: unknown
} cj_glass_info;
CONTREJOUR_API cj_status cj_glass_get_info(const cj_glass* glass, cj_glass_info* info, cj_error* error);

// The refractive index relative to air at each wavelength.
CONTREJOUR_API cj_status cj_glass_indices(const cj_glass* glass, const double* wavelengths_nm, size_t count,
                                          double* indices, cj_error* error);
// The internal transmittance of a path within the glass; 1 where the catalogue has no measurements.
CONTREJOUR_API cj_status cj_glass_transmittances(const cj_glass* glass, double path_mm, const double* wavelengths_nm,
                                                 size_t count, double* transmittances, cj_error* error);

// ---- Coatings

typedef struct cj_coating cj_coating;
// A text of the parameter "coating": "none", "v-coat:550", "broadband-6", "stack:MgF2@99.6,ZrO2@137" from air to glass,
// "measured:FILE", ... A design gets its films for each glass that it lies on.
CONTREJOUR_API cj_status cj_coating_read(const char* text, cj_coating** coating, cj_error* error);
CONTREJOUR_API void cj_coating_destroy(cj_coating* coating);
CONTREJOUR_API const char* cj_coating_description(const cj_coating* coating);
CONTREJOUR_API size_t cj_coating_design_count(void);
CONTREJOUR_API const char* cj_coating_design_name(size_t index);  // NULL beyond the last

// Unpolarised reflectance of a coated glass for light from air, by wavelength and angle of incidence in air (0 to
// pi / 2): arrays of `count` elements.
CONTREJOUR_API cj_status cj_coating_reflectances(const cj_coating* coating, const cj_glass* glass,
                                                 const double* wavelengths_nm, const double* angles_rad, size_t count,
                                                 double* reflectances, cj_error* error);
CONTREJOUR_API cj_status cj_coating_transmittances(const cj_coating* coating, const cj_glass* glass,
                                                   const double* wavelengths_nm, const double* angles_rad, size_t count,
                                                   double* transmittances, cj_error* error);

// The coating's films on a glass, refined to reflect `targets` at these wavelengths at normal incidence, in the sense
// of least squares with these weights (NULL: all 1). The optimum is local. Errors: a coating without films.
CONTREJOUR_API cj_status cj_coating_refine(const cj_coating* coating, const cj_glass* glass,
                                           const double* wavelengths_nm, const double* targets, const double* weights,
                                           size_t count, cj_coating** refined, cj_error* error);
// The films on this glass: those of a stack, a design or a quarter-wave coating. Errors: a coating without films.
CONTREJOUR_API cj_status cj_coating_on_glass(const cj_coating* coating, const cj_glass* glass, cj_coating** films,
                                             cj_error* error);

typedef struct cj_film {
  size_t struct_size;
  const char* material;  // "MgF2"; empty: the index below at every wavelength
  double n, k;  // at 550 nm
  double thickness_nm;
} cj_film;
CONTREJOUR_API size_t cj_coating_film_count(const cj_coating* coating);  // from air to glass; 0 for a design
CONTREJOUR_API cj_status cj_coating_get_film(const cj_coating* coating, size_t index, cj_film* film, cj_error* error);

// ---- Lenses changed and written

enum {
  CJ_CHANGE_CURVATURE = 1,
  CJ_CHANGE_THICKNESS = 2,
  CJ_CHANGE_SEMI_DIAMETER = 4,
  CJ_CHANGE_GLASS = 8,
  CJ_CHANGE_COATING = 16
};
typedef struct cj_surface_change {
  size_t struct_size;
  uint32_t what;  // a sum of CJ_CHANGE_...
  double curvature_per_mm, thickness_mm, semi_diameter_mm;
  const char* glass_behind;  // as cj_glass_find() takes it
  const char* coating;  // as cj_coating_read() takes it
} cj_surface_change;
// A copy of the lens with one surface (from 0) changed. Errors: a lens that cannot be.
CONTREJOUR_API cj_status cj_lens_with_surface(const cj_lens* lens, size_t index, const cj_surface_change* change,
                                              cj_lens** changed, cj_error* error);

// Text that a function made, with notes of what its format cannot hold.
typedef struct cj_text cj_text;
CONTREJOUR_API void cj_text_destroy(cj_text* text);
CONTREJOUR_API const char* cj_text_data(const cj_text* text);
CONTREJOUR_API size_t cj_text_size(const cj_text* text);  // without the zero byte
CONTREJOUR_API const char* cj_text_note(const cj_text* text, size_t index);  // NULL beyond the last

// format: "toml" (docs/formats/lens-toml.md), "zmx" (Zemax) or "seq" (CODE V).
CONTREJOUR_API cj_status cj_lens_write(const cj_lens* lens, const char* format, cj_text** text, cj_error* error);
// The path of a ghost, with mirrors, for a design program: "zmx" or "seq". surfaces: as in cj_ghost.
CONTREJOUR_API cj_status cj_lens_state_write_ghost(const cj_lens_state* state, const int32_t surfaces[4],
                                                   const char* format, cj_text** text, cj_error* error);

// ---- Third-order aberrations, in mm of path

typedef struct cj_seidel {
  size_t struct_size;
  double spherical, coma, astigmatism, petzval, distortion;  // S_I to S_V
  double axial_colour, lateral_colour;  // C_I, C_II from the F to the C line
} cj_seidel;
// The sums of one surface (from 0), or of the whole lens (-1). wavelength_nm, half_field_rad: 0 stands for the design's
// wavelength and the sensor's field.
CONTREJOUR_API cj_status cj_lens_state_get_seidel(const cj_lens_state* state, double wavelength_nm,
                                                  double half_field_rad, int32_t surface, cj_seidel* sums,
                                                  cj_error* error);

// ---- Rays

typedef int32_t cj_ray_status;
enum { CJ_RAY_OK = 0, CJ_RAY_MISSED = 1, CJ_RAY_TOTAL_REFLECTION = 2, CJ_RAY_NOT_FINITE = 3 };

typedef struct cj_traced_ray {
  size_t struct_size;
  cj_ray_status status;
  double sensor_mm[2];  // right and up in the picture are negative
  double direction[3];
  double transmission;  // product of the reflectances and transmittances along the path
  double relative_height;  // largest distance from the axis over the clear semi-diameter
  double blocked_by;  // how far outside rims and iris; <= 0 gets through
} cj_traced_ray;
// Traces `count` rays along one path on the calling thread: the direct path where `surfaces` is NULL, or else a ghost's
// (as in cj_ghost). origins_mm, directions: three numbers a ray, z = 0 at the first vertex; directions need not have
// length 1. rays: an array of structs; the first one's struct_size counts. wavelength_nm: 0 for the design's.
CONTREJOUR_API cj_status cj_trace(const cj_lens_state* state, const int32_t surfaces[4], double wavelength_nm,
                                  const double* origins_mm, const double* directions, size_t count, cj_traced_ray* rays,
                                  cj_error* error);

// ---- Sections

typedef struct cj_section_options {
  size_t struct_size;
  double wavelength_nm;  // 0: the design's
  const char* ghosts;  // "2-5,3-7"; NULL or empty: the rays that form the image
  double ghost_light_rad;  // elevation of the ghosts' light
  int32_t has_ghost_light;  // 0: a third of the field
} cj_section_options;

typedef struct cj_section cj_section;
CONTREJOUR_API cj_status cj_section_create(const cj_lens_state* state, const cj_section_options* options,
                                           cj_section** section, cj_error* error);  // options may be NULL
CONTREJOUR_API void cj_section_destroy(cj_section* section);
// The drawing of `contrejour lens draw`.
CONTREJOUR_API const char* cj_section_svg(const cj_section* section);

typedef int32_t cj_line_kind;
enum {
  CJ_LINE_ELEMENT = 0,  // outline of glass, closed; index: its front surface
  CJ_LINE_SURFACE = 1,  // index: the surface
  CJ_LINE_OBSCURATION = 2,
  CJ_LINE_STOP = 3,  // a blade
  CJ_LINE_SENSOR = 4,
  CJ_LINE_AXIS_RAY = 5,
  CJ_LINE_FIELD_RAY = 6,
  CJ_LINE_GHOST_RAY = 7  // index: its ghost among those that were asked for
};
typedef struct cj_section_line {
  size_t struct_size;
  cj_line_kind kind;
  int32_t is_blocked;  // a ray that a clear aperture blocks
  size_t index;
  const double* points_mm;  // z and y of each point; z from the first vertex, y upwards
  size_t point_count;
} cj_section_line;
CONTREJOUR_API size_t cj_section_line_count(const cj_section* section);
CONTREJOUR_API cj_status cj_section_get_line(const cj_section* section, size_t index, cj_section_line* line,
                                             cj_error* error);

#ifdef __cplusplus
}
#endif
