// SPDX-License-Identifier: Apache-2.0
// The buffers, parameters and positions of the shaders that add starbursts to a picture, as
// src/vulkan/starburst_words.h lays them out. Positions are relative to the light's image, in pixels, y up; directions
// are counted as in src/diffraction/starburst_rings.h, in half turns from straight down.
layout(std430, set = 0, binding = 7) buffer Picture { float picture[]; };
layout(std430, set = 0, binding = 27) readonly buffer Starbursts { uint starbursts[]; };  // lights, then patterns

layout(push_constant) uniform Parameters {
  uint light_count;
  int width, height;
  int first_row;  // of the picture, in the frame that the lights' positions refer to
  uint light;     // near.comp: the light
  int left, top;  // near.comp: the picture's first pixel that is drawn
  uint sharing;   // near.comp: the invocations of a pixel, 64 for those about the image's own
}
p;

#define PI 3.14159265
#define ROWS_PER_OCTAVE 92  // kRowsPerOctave
#define NEAR_PX 48.0        // kNear_px
#define LIGHT_WORDS 8u
#define FAR_WORDS 4u
#define ZONE_WORDS 4u
#define NEAR_WORDS 8u

float float_at(uint word) { return uintBitsToFloat(starbursts[word]); }
vec3 rgb_at(uint word) { return vec3(float_at(word), float_at(word + 1u), float_at(word + 2u)); }

// The words of a light: its pattern; the pixel of its image; the middle of that pixel, from the image, y down; its
// flux.
uint pattern_of(uint light) { return starbursts[LIGHT_WORDS * light]; }
vec3 flux_of(uint light) { return rgb_at(LIGHT_WORDS * light + 5u); }

// The pixels between that of a light's image and a pixel of the picture, y down.
ivec2 whole_pixels(uint light, ivec2 pixel) {
  uint word = LIGHT_WORDS * light;
  return ivec2(pixel.x, pixel.y + p.first_row) - ivec2(starbursts[word + 1u], starbursts[word + 2u]);
}

// The middle of a pixel of the picture, from a light's image. Whole pixels are subtracted as integers, so that it is as
// exact far from the frame's corner as at it.
vec2 from_image(uint light, ivec2 pixel) {
  uint word = LIGHT_WORDS * light;
  precise vec2 at = vec2(whole_pixels(light, pixel)) + vec2(float_at(word + 3u), float_at(word + 4u));
  return vec2(at.x, -at.y);
}

// Both shaders decide alike to which of them a pixel belongs.
bool is_near(vec2 at) {
  precise float squared = at.x * at.x + at.y * at.y;
  return squared < NEAR_PX * NEAR_PX;
}

// The arc tangent of 0 to 1, to 2e-7 of its value; GLSL's own may be off by 4096 units in the last place. Source: S.
// Moshier, Cephes, atanf.
float arc_tangent(float x) {
  const float eighth = 0.41421356;  // tan(pi / 8)
  bool is_large = x > eighth;
  float y = is_large ? (x - 1.0) / (x + 1.0) : x, z = y * y;
  float series = ((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1;
  series = series * z * y + y;
  return is_large ? 0.25 * PI + series : series;
}

// The angle between a direction and the horizontal, in half turns, 0 to 1/2.
float slope_turns(vec2 at) {
  float x = abs(at.x), y = abs(at.y), most = max(x, y);
  if (!(most > 0.0)) return 0.0;
  float turns = arc_tangent(min(x, y) / most) / PI;
  return y > x ? 0.5 - turns : turns;
}
