// SPDX-License-Identifier: Apache-2.0
// Renders the flare of a lens through the C interface, and lists its brightest ghosts:
//
//     flare LENS OUTPUT.pfm [NAME=TEXT ...]
//     flare heliar flare.pfm fnumber=8 light=12,8:1000 size=960x640
//
// NAME and TEXT are those of the command line's options (`contrejour render --help`).
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <contrejour.h>

enum { GHOSTS_LISTED = 5, TEXT_SIZE = 256 };

static int fail(const cj_error* error) {
  fprintf(stderr, "flare: %s (%s)\n", error->message, cj_status_name(error->status));
  return EXIT_FAILURE;
}

// Sets "NAME=TEXT".
static cj_status set_option(cj_settings* settings, const char* option, cj_error* error) {
  char name[TEXT_SIZE];
  const char* const equals = strchr(option, '=');
  const size_t length = equals != NULL ? (size_t)(equals - option) : strlen(option);
  if (length >= sizeof(name)) return cj_settings_set(settings, option, "", error);
  memcpy(name, option, length);
  name[length] = '\0';
  return cj_settings_set(settings, name, equals != NULL ? equals + 1 : "on", error);
}

static cj_status print_lens(const cj_lens* lens, const cj_lens_state* state, cj_error* error) {
  cj_lens_info info = CJ_INIT(cj_lens_info);
  cj_lens_figures figures = CJ_INIT(cj_lens_figures);
  cj_status status = cj_lens_get_info(lens, &info, error);
  if (status == CJ_OK) status = cj_lens_state_get_figures(state, 0.0, &figures, error);
  if (status != CJ_OK) return status;
  printf("%s\n%s\n%.2f mm, f/%.3g\n", info.name, info.source, figures.focal_length_mm, figures.f_number);
  for (size_t k = 0; k < info.surface_count && status == CJ_OK; ++k) {
    cj_surface surface = CJ_INIT(cj_surface);
    status = cj_lens_get_surface(lens, k, &surface, error);
    if (status == CJ_OK)
      printf("%3d  curvature %9.5f /mm  thickness %8.3f mm  %-10s %s\n", (int)k + 1, surface.curvature_per_mm,
             surface.thickness_mm, surface.glass_behind, surface.coating);
  }
  return status;
}

static cj_status print_ghosts(const cj_lens_state* state, const cj_settings* settings, cj_error* error) {
  cj_ghost_list* ghosts = NULL;
  cj_status status = cj_measure_ghosts(state, settings, NULL, NULL, &ghosts, error);
  if (status != CJ_OK) return status;
  const size_t count = cj_ghost_list_count(ghosts);
  printf("%d ghosts, the brightest:\n", (int)count);
  for (size_t k = 0; k < count && k < GHOSTS_LISTED && status == CJ_OK; ++k) {
    cj_ghost ghost = CJ_INIT(cj_ghost);
    status = cj_ghost_list_get(ghosts, k, &ghost, error);
    if (status == CJ_OK)
      printf("  %d-%d  flux %.3g of the light's, at %.1f, %.1f px\n", (int)ghost.surfaces[0], (int)ghost.surfaces[1],
             ghost.relative_flux, ghost.x_px, ghost.y_px);
  }
  cj_ghost_list_destroy(ghosts);
  return status;
}

static int32_t show_progress(void* user, double done) {
  (void)user;
  fprintf(stderr, "\r%3.0f %%", 100.0 * done);
  return 0;  // anything else stops the rendering
}

// The size in the settings, "WxH".
static cj_status picture_size(const cj_settings* settings, int* width, int* height, cj_error* error) {
  char text[TEXT_SIZE];
  const cj_status status = cj_settings_get(settings, "size", 0, text, sizeof(text), NULL, error);
  if (status == CJ_OK) sscanf(text, "%dx%d", width, height);
  return status;
}

static cj_status render(const cj_lens_state* state, const cj_settings* settings, cj_image* image, cj_error* error) {
  cj_renderer* renderer = NULL;
  cj_statistics statistics = CJ_INIT(cj_statistics);
  cj_context context = CJ_INIT(cj_context);
  context.progress = show_progress;
  cj_status status = cj_renderer_create(&renderer, error);
  if (status == CJ_OK) status = cj_renderer_set_lens(renderer, state, error);
  if (status == CJ_OK) status = cj_renderer_render(renderer, settings, NULL, 0, image, &context, &statistics, error);
  if (status == CJ_OK) fprintf(stderr, "\r%d ghosts, %.0f ms\n", (int)statistics.ghosts_rendered, statistics.total_ms);
  cj_renderer_destroy(renderer);
  return status;
}

// A portable float map: rows from the bottom, in this machine's (little-endian) byte order.
static int write_pfm(const char* file, const cj_image* image) {
  const size_t row = (size_t)image->width * 3;
  FILE* const out = fopen(file, "wb");
  if (out == NULL) return 0;
  int good = fprintf(out, "PF\n%d %d\n-1.0\n", (int)image->width, (int)image->height) > 0;
  for (int y = image->height - 1; y >= 0 && good; --y)
    good = fwrite((const float*)image->pixels + (size_t)y * row, sizeof(float), row, out) == row;
  return fclose(out) == 0 && good;
}

static int flare(const cj_lens* lens, const cj_settings* settings, const char* output) {
  cj_error error = CJ_INIT(cj_error);
  cj_lens_state* state = NULL;
  int width = 0, height = 0;
  if (cj_lens_configure(lens, settings, &state, &error) != CJ_OK) return fail(&error);
  cj_lens_info info = CJ_INIT(cj_lens_info);
  cj_status status = cj_lens_get_info(lens, &info, &error);
  if (status == CJ_OK && !info.is_measured_flare) {  // a flare measured from photographs has no surfaces
    status = print_lens(lens, state, &error);
    if (status == CJ_OK) status = print_ghosts(state, settings, &error);
  }
  if (status == CJ_OK) status = picture_size(settings, &width, &height, &error);
  int result = EXIT_SUCCESS;
  if (status == CJ_OK) {
    cj_image image = CJ_INIT(cj_image);
    image.width = width;
    image.height = height;
    image.pixels = calloc((size_t)width * (size_t)height * 3, sizeof(float));
    status = render(state, settings, &image, &error);
    if (status == CJ_OK && !write_pfm(output, &image)) {
      fprintf(stderr, "flare: cannot write %s\n", output);
      result = EXIT_FAILURE;
    }
    free(image.pixels);
  }
  if (status != CJ_OK) result = fail(&error);
  cj_lens_state_destroy(state);
  return result;
}

int main(int count, char** arguments) {
  cj_error error = CJ_INIT(cj_error);
  cj_settings* settings = NULL;
  cj_lens* lens = NULL;
  if (count < 3) {
    fprintf(stderr, "usage: flare LENS OUTPUT.pfm [NAME=TEXT ...]     (contrejour %s)\n", cj_version_string());
    return 2;
  }
  cj_status status = cj_settings_create(&settings, &error);
  for (int k = 3; k < count && status == CJ_OK; ++k) status = set_option(settings, arguments[k], &error);
  if (status == CJ_OK) status = cj_lens_find(arguments[1], &lens, &error);
  const int result = status == CJ_OK ? flare(lens, settings, arguments[2]) : fail(&error);
  cj_lens_destroy(lens);
  cj_settings_destroy(settings);
  return result;
}
