// SPDX-License-Identifier: Apache-2.0
// Contrejour's C interface (C99): lenses, settings, renderers, flare on photographs, lights and ghosts. docs/c.md shows
// a program. The C++ interface is contrejour/contrejour.h.
//
// Objects are opaque and are created and destroyed by functions; destroying NULL does nothing. Structs begin with
// struct_size, which the caller sets to the struct's size (CJ_INIT does); later versions append members, and both sides
// then use those that both know. In an array of structs, the first element's struct_size is the distance from each
// element to the next. Functions that can fail return a status and describe the failure in *error, which may be NULL.
// After an error, outputs are unchanged, except pixels, which may be written in part. Nothing is thrown, and nothing is
// printed.
//
// Text is UTF-8 and ends with a zero byte. Text that a function returns by pointer belongs to the object that it was
// asked of, and to the library where there is none. Lengths are in mm, angles in radians, wavelengths in nm, pixel
// values linear; settings are text in the units of the table of parameters.
//
// Thread-safety: functions may run at the same time on any threads, as long as no object is used by one call that
// changes it (its pointer is not const) while another call uses it. A cj_cancel may be set at any time. Results do not
// depend on the number of threads.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "contrejour/export.h"

#ifdef __cplusplus
extern "C" {
#endif

// ---- Versions

#define CJ_VERSION_MAJOR 0
#define CJ_VERSION_MINOR 1
#define CJ_VERSION_PATCH 0

CONTREJOUR_API const char* cj_version_string(void);  // of the library that runs: "0.1.0"
CONTREJOUR_API void cj_version(int32_t* major, int32_t* minor, int32_t* patch);  // each may be NULL

// ---- Errors

typedef int32_t cj_status;
enum {
  CJ_OK = 0,
  CJ_INVALID_ARGUMENT = 1,  // a value out of its range
  CJ_PARSE = 2,  // a file that is not what its format says
  CJ_IO = 3,  // cannot open, read or write
  CJ_UNSUPPORTED = 4,  // understood, but not modelled
  CJ_CANCELLED = 5,  // the caller asked to stop
  CJ_OUT_OF_MEMORY = 6,
  CJ_INTERNAL = 7  // a fault of the library
};
CONTREJOUR_API const char* cj_status_name(cj_status status);  // "invalid argument"

enum { CJ_MESSAGE_SIZE = 2048 };

typedef struct cj_error {
  size_t struct_size;
  cj_status status;
  int32_t line, column;  // in the file that the message names, from 1; 0: unknown
  char message[CJ_MESSAGE_SIZE];  // "file:line: what is wrong, and what to do"; cut where it is longer
} cj_error;

// A struct with its size, and zero in all other members: cj_error error = CJ_INIT(cj_error);
// clang-format off
#ifdef __cplusplus
#define CJ_INIT(type) ([] { type made{}; made.struct_size = sizeof(type); return made; }())
#else
#define CJ_INIT(type) { .struct_size = sizeof(type) }
#endif
// clang-format on

// ---- Cancelling and progress

typedef struct cj_cancel cj_cancel;
CONTREJOUR_API cj_status cj_cancel_create(cj_cancel** cancel, cj_error* error);
CONTREJOUR_API void cj_cancel_destroy(cj_cancel* cancel);
// Stops every call whose context names it, within some milliseconds; 0 resets it.
CONTREJOUR_API void cj_cancel_set(cj_cancel* cancel, int32_t stop);

// Long calls take a context, which may be NULL. Their number of threads is the setting "threads".
typedef struct cj_context {
  size_t struct_size;
  cj_cancel* cancel;  // may be NULL
  // Called with rising numbers from 0 to 1, from any thread, never by two at once; a result other than 0 stops the
  // call, and sets `cancel` if there is one. May be NULL.
  int32_t (*progress)(void* user, double done);
  void* user;
} cj_context;

// ---- The table of parameters: everything that a user can set

typedef int32_t cj_parameter_kind;
enum { CJ_REAL = 0, CJ_INTEGER = 1, CJ_CHOICE = 2, CJ_SWITCH = 3, CJ_TEXT = 4 };

typedef struct cj_parameter {
  size_t struct_size;
  const char* name;  // "fnumber"
  const char* group;  // heading in a list of parameters
  const char* unit;  // "mm", "deg", ..., or how a text is written: "WxH"; may be empty
  const char* fallback;  // default as text; empty: derived from the lens or the picture, as `help` says
  const char* help;
  const char* const* choices;  // of CJ_CHOICE
  size_t choice_count;
  double minimum, maximum;  // of CJ_REAL and CJ_INTEGER; may be infinite
  cj_parameter_kind kind;
  int32_t repeats;  // 1: may be given several times
  int32_t is_scene;  // 1: describes one picture, as lights and size do, and is no part of a preset
} cj_parameter;

CONTREJOUR_API size_t cj_parameter_count(void);
CONTREJOUR_API cj_status cj_parameter_get(size_t index, cj_parameter* parameter, cj_error* error);

// ---- Settings: values of parameters, as text

typedef struct cj_settings cj_settings;
CONTREJOUR_API cj_status cj_settings_create(cj_settings** settings, cj_error* error);  // nothing given: all defaults
CONTREJOUR_API cj_status cj_settings_copy(const cj_settings* settings, cj_settings** copy, cj_error* error);
CONTREJOUR_API void cj_settings_destroy(cj_settings* settings);

// Sets a value ("fnumber", "8"), or adds one to a parameter that repeats ("light", "12,8:1000"). Switches are "on" or
// "off". Errors: no such parameter; a text that is not a value of it.
CONTREJOUR_API cj_status cj_settings_set(cj_settings* settings, const char* name, const char* text, cj_error* error);
// Forgets what was given, so that the default counts again.
CONTREJOUR_API cj_status cj_settings_reset(cj_settings* settings, const char* name, cj_error* error);

// How many values a parameter has: those given, or its default if it has one.
CONTREJOUR_API cj_status cj_settings_count(const cj_settings* settings, const char* name, size_t* count,
                                           cj_error* error);
// Copies one of them to a buffer of `size` bytes, cut to fit and with its zero byte. *length (may be NULL) is that of
// the whole text without the zero byte.
CONTREJOUR_API cj_status cj_settings_get(const cj_settings* settings, const char* name, size_t index, char* buffer,
                                         size_t size, size_t* length, cj_error* error);

// A bundled preset, or else a file: gives what the settings have not given themselves.
CONTREJOUR_API cj_status cj_settings_load_preset(cj_settings* settings, const char* name_or_file, cj_error* error);
// The lens for which the preset that was loaded last was made; empty: none.
CONTREJOUR_API const char* cj_settings_lens(const cj_settings* settings);
CONTREJOUR_API size_t cj_bundled_preset_count(void);
CONTREJOUR_API const char* cj_bundled_preset_name(size_t index);  // NULL beyond the last

// ---- Lenses as published

typedef struct cj_lens cj_lens;
CONTREJOUR_API size_t cj_bundled_lens_count(void);
CONTREJOUR_API const char* cj_bundled_lens_name(size_t index);  // NULL beyond the last

// A bundled lens, or else a file in any of the formats that the library reads; also a measured flare (NAME.flare.toml),
// which can be configured, rendered and applied as a lens, by the settings that `contrejour render` takes for one.
CONTREJOUR_API cj_status cj_lens_find(const char* name_or_file, cj_lens** lens, cj_error* error);
// The library's own format (docs/formats/lens-toml.md) from memory; `file` names it in errors.
CONTREJOUR_API cj_status cj_lens_read_toml(const char* text, const char* file, cj_lens** lens, cj_error* error);
CONTREJOUR_API void cj_lens_destroy(cj_lens* lens);

typedef struct cj_lens_info {
  size_t struct_size;
  const char* name;
  const char* source;  // patent or book
  double f_number;  // widest
  double shortest_focal_length_mm, longest_focal_length_mm;  // of a zoom, nominal; 0 for a prime
  double sensor_width_mm, sensor_height_mm;
  size_t surface_count, warning_count;
  int32_t is_measured_flare;  // 1: a flare measured from photographs, which has no surfaces
} cj_lens_info;
CONTREJOUR_API cj_status cj_lens_get_info(const cj_lens* lens, cj_lens_info* info, cj_error* error);
// A warning of the reader, of what it interpreted differently from the file; NULL beyond the last.
CONTREJOUR_API const char* cj_lens_warning(const cj_lens* lens, size_t index);

typedef int32_t cj_surface_kind;
enum { CJ_REFRACTING = 0, CJ_STOP = 1 };

typedef struct cj_surface {
  size_t struct_size;
  cj_surface_kind kind;
  int32_t is_sphere;  // 1: a sphere or a plane, centred
  double curvature_per_mm;  // 1 / radius, 0 for a plane, > 0 when the centre lies behind the surface
  double thickness_mm;  // to the next vertex
  double semi_diameter_mm;
  double index_d, abbe_d;  // of the medium behind; abbe_d is not finite without dispersion
  const char* glass_behind;  // as the lens file has it; "air"
  const char* coating;  // "none", "quarter-wave 550 nm n=1.38", ...
} cj_surface;
// Surfaces count from 0 here, and from 1 where users see a number.
CONTREJOUR_API cj_status cj_lens_get_surface(const cj_lens* lens, size_t index, cj_surface* surface, cj_error* error);

// ---- Lenses configured for a picture: zoom, f-number, focus, iris, coatings, dirt, sensor

typedef struct cj_lens_state cj_lens_state;
// settings may be NULL: all defaults.
CONTREJOUR_API cj_status cj_lens_configure(const cj_lens* lens, const cj_settings* settings, cj_lens_state** state,
                                           cj_error* error);
CONTREJOUR_API void cj_lens_state_destroy(cj_lens_state* state);

typedef struct cj_lens_figures {
  size_t struct_size;
  double focal_length_mm;
  double f_number;
  double object_distance_mm;  // focus, from surface 1; may be infinite
  double stop_radius_mm;
  double sensor_width_mm, sensor_height_mm;
  double sensor_position_mm;  // from the last vertex
  double back_focal_distance_mm;  // from the last vertex to the rear focal point
  double front_focal_distance_mm;  // from surface 1; negative in front of the lens
  double entrance_pupil_position_mm;  // from surface 1
  double entrance_pupil_diameter_mm;
  double exit_pupil_position_mm;  // from the sensor; negative towards the lens
  double exit_pupil_diameter_mm;
  double half_field_rad;  // of the sensor's half diagonal
  double wavelength_nm;  // for which they are computed
} cj_lens_figures;
// First-order figures at a wavelength; 0: the lens's design wavelength.
CONTREJOUR_API cj_status cj_lens_state_get_figures(const cj_lens_state* state, double wavelength_nm,
                                                   cj_lens_figures* figures, cj_error* error);

// ---- Images: a caller's memory

typedef int32_t cj_sample;
enum { CJ_FLOAT = 0, CJ_HALF = 1 };

// Red, green and blue, linear, rows from the top. Steps are in bytes and may be negative: hosts whose rows run from the
// bottom up give the address of the last row and a negative row_step. What lies beyond blue is not touched.
typedef struct cj_image {
  size_t struct_size;
  void* pixels;  // the red sample of the top left pixel; need not be aligned
  int32_t width, height;
  cj_sample sample;
  ptrdiff_t channel_step;  // from red to green to blue; 0: that of packed samples
  ptrdiff_t pixel_step;  // 0: that of packed RGB
  ptrdiff_t row_step;  // 0: that of packed rows
} cj_image;

// ---- Lights, in addition to those of the settings

typedef struct cj_light {
  size_t struct_size;
  double direction[3];  // unit, of travel to the lens, z > 0: cj_direction_from_angles(), cj_direction_from_image()
  double value[3];  // the sum of the light's direct image over its pixels, per channel
  double distance_mm;  // to surface 1; 0 or infinity: distant
  double radius_rad;  // angular radius of a disc; 0: a point
  const char* spectrum;  // "D65", "3200K", "sodium", a file ...; NULL: D65
} cj_light;

// Azimuth to the right and elevation up, as the photographer sees them.
CONTREJOUR_API cj_status cj_direction_from_angles(double azimuth_rad, double elevation_rad, double direction[3],
                                                  cj_error* error);
// The direction of a light whose image is at u, v of the whole picture (0, 0 top left, 1, 1 bottom right); settings
// (may be NULL) give the picture's size and field of view. distance_mm: 0 or infinity for a distant light.
CONTREJOUR_API cj_status cj_direction_from_image(const cj_lens_state* state, const cj_settings* settings, double u,
                                                 double v, double distance_mm, double direction[3], cj_error* error);

// ---- Rendering

// A renderer keeps what frames have in common. One thread at a time uses it; two renderers share nothing.
typedef struct cj_renderer cj_renderer;
CONTREJOUR_API cj_status cj_renderer_create(cj_renderer** renderer, cj_error* error);
CONTREJOUR_API void cj_renderer_destroy(cj_renderer* renderer);
// The lens of the frames that follow; the state may then be destroyed.
CONTREJOUR_API cj_status cj_renderer_set_lens(cj_renderer* renderer, const cj_lens_state* state, cj_error* error);

typedef struct cj_statistics {
  size_t struct_size;
  double total_ms;
  uint64_t rays;
  uint64_t primitives;  // what the method draws: polygons, triangles
  uint64_t peak_memory_bytes;
  int32_t ghosts_rendered;
  double ghosts_skipped_flux;  // fraction of the flux that the selection left out; NaN: unknown
} cj_statistics;

// Renders what the lights add to a photograph, in their own units. The picture has the image's size, whatever "size" in
// the settings (which may be NULL) says; its lights are those given, then those of the settings; without any, one at
// u, v = 0.70, 0.33. context and statistics may be NULL.
CONTREJOUR_API cj_status cj_renderer_render(cj_renderer* renderer, const cj_settings* settings, const cj_light* lights,
                                            size_t light_count, const cj_image* image, const cj_context* context,
                                            cj_statistics* statistics, cj_error* error);

// ---- Flare of a photograph's own lights

typedef int32_t cj_apply_output;
enum { CJ_PICTURE_WITH_FLARE = 0, CJ_FLARE_ONLY = 1 };

typedef struct cj_flare_report {
  size_t struct_size;
  size_t lights_found, lights_given;
  double threshold;  // level above which a pixel belongs to a light
  double brightest;  // the flare's luminance at its 99.5th percentile, without the lights' pixels
  double relative_to_picture;  // the 99.5th percentile of the flare's luminance over the picture's
  double stops_to_obvious;  // gain in stops at which the flare is obvious; NaN: there is no flare
} cj_flare_report;

// Finds the lights of `picture` (linear, white at 1) and writes the picture with their flare, or the flare alone, to
// `result`, which has the same size and may be the same memory. With CJ_PICTURE_WITH_FLARE into the same memory and
// sample type, samples without flare keep their bits. report may be NULL.
CONTREJOUR_API cj_status cj_apply(const cj_lens_state* state, const cj_settings* settings, const cj_image* picture,
                                  const cj_image* result, cj_apply_output output, const cj_context* context,
                                  cj_flare_report* report, cj_error* error);

typedef struct cj_light_list cj_light_list;
// The lights of a photograph, the largest flux first.
CONTREJOUR_API cj_status cj_detect_lights(const cj_settings* settings, const cj_image* picture, cj_light_list** lights,
                                          cj_error* error);
CONTREJOUR_API void cj_light_list_destroy(cj_light_list* lights);
CONTREJOUR_API size_t cj_light_list_count(const cj_light_list* lights);
CONTREJOUR_API double cj_light_list_threshold(const cj_light_list* lights);  // the level that was used

typedef struct cj_detected_light {
  size_t struct_size;
  double x_px, y_px;  // flux-weighted; the top left pixel's centre is (0.5, 0.5)
  double flux[3];  // sum over its pixels, per channel
  double rms_radius_px;
  double peak;  // largest level in the picture
  int32_t min_x, min_y, max_x, max_y;  // pixels, inclusive
  int64_t pixel_count;
} cj_detected_light;
CONTREJOUR_API cj_status cj_light_list_get(const cj_light_list* lights, size_t index, cj_detected_light* light,
                                           cj_error* error);

// ---- Ghosts

typedef struct cj_ghost_list cj_ghost_list;
// The ghosts of one light, the brightest first: `light`, or if it is NULL the first of the settings.
CONTREJOUR_API cj_status cj_measure_ghosts(const cj_lens_state* state, const cj_settings* settings,
                                           const cj_light* light, const cj_context* context, cj_ghost_list** ghosts,
                                           cj_error* error);
CONTREJOUR_API void cj_ghost_list_destroy(cj_ghost_list* ghosts);
CONTREJOUR_API size_t cj_ghost_list_count(const cj_ghost_list* ghosts);

typedef struct cj_ghost {
  size_t struct_size;
  // Surfaces count from 1. The light reflects first at [1], then at [0]; of four reflections then at [3] and at [2].
  int32_t surfaces[4];  // 0: no such reflection
  int32_t order[2];  // of diffraction at the sensor
  double relative_flux;  // luminance of `rgb`
  double rgb[3];  // flux over the direct image's flux, per channel
  double peak_irradiance;  // over the light's irradiance at the front, as a mean over a pixel
  double reflectance;  // product of its surfaces' reflectances at normal incidence
  double x_px, y_px, width_px, height_px;  // flux-weighted middle, and box of its footprint, in a picture of "size"
  double x_mm, y_mm, width_mm, height_mm;  // the same on the sensor: right and up in the picture are negative
  double focus_mm;  // from the sensor to its paraxial focus, positive behind; NaN: it leaves parallel
  double blur_mm;  // first-order diameter of its spot on the sensor
  int32_t in_focus, is_pupil_ghost;
} cj_ghost;
CONTREJOUR_API cj_status cj_ghost_list_get(const cj_ghost_list* ghosts, size_t index, cj_ghost* ghost, cj_error* error);

#ifdef __cplusplus
}
#endif
