// SPDX-License-Identifier: Apache-2.0
// A path tracer's camera with a real lens, without this library: a scene of lamps in front of a chequered wall.
//
//     contrejour polynomial fit planar-50 --focus 1500 --direct -o planar.poly
//     contrejour polynomial export planar.poly --wavelength 550 -o lens.c
//     cc -O2 examples/c/camera.c -I. -o camera -lm
//     ./camera picture.pgm 360 240 64 1.0
//
// Arguments: the picture, its width and height, rays a pixel, the radius of the opening over the widest one.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "lens.c"

static const double kPi = 3.14159265358979323846;
static const double kSensorWidth_mm = 36.0, kLambda_nm = 550.0;
static const double kWall_mm = -6000.0, kLamps_mm = -3000.0, kSharp_mm = -1500.0;

// The radiance that arrives along a ray of the scene: mm, x right, y up, the camera looks to -z.
static double radiance(const double origin[3], const double direction[3]) {
  // A ruler of dark and bright bars where the lens is focused, below the middle.
  double t = (kSharp_mm - origin[2]) / direction[2];
  double x = origin[0] + t * direction[0], y = origin[1] + t * direction[1];
  if (y < -150.0) return fmod(fabs(x), 40.0) < 20.0 ? 0.8 : 0.05;
  // Lamps of 10 mm, 300 mm apart.
  t = (kLamps_mm - origin[2]) / direction[2];
  x = origin[0] + t * direction[0];
  y = origin[1] + t * direction[1];
  const double dx = x - 300.0 * floor(x / 300.0 + 0.5), dy = y - 300.0 * floor(y / 300.0 + 0.5);
  if (dx * dx + dy * dy < 100.0) return 300.0;
  t = (kWall_mm - origin[2]) / direction[2];
  x = floor((origin[0] + t * direction[0]) / 400.0);
  y = floor((origin[1] + t * direction[1]) / 400.0);
  return fmod(fabs(x + y), 2.0) < 1.0 ? 0.15 : 0.05;
}

static double unit(uint64_t* state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 33) / 2147483648.0;
}

int main(int count, char** arguments) {
  if (count != 6) {
    fprintf(stderr, "usage: camera PICTURE.pgm WIDTH HEIGHT RAYS OPENING\n");
    return 2;
  }
  const int width = atoi(arguments[2]), height = atoi(arguments[3]), rays = atoi(arguments[4]);
  const double opening = atof(arguments[5]), pixel_mm = kSensorWidth_mm / width;
  if (width < 1 || height < 1 || rays < 1 || width > 8192 || height > 8192) return 2;
  FILE* file = fopen(arguments[1], "wb");
  if (file == NULL) return 1;
  fprintf(file, "P5\n%d %d\n255\n", width, height);
  uint64_t random = 1;
  double middle = 0.0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      double irradiance = 0.0;
      for (int k = 0; k < rays; ++k) {
        // The image on the sensor is upside down and mirrored, and pictures are upright.
        const double x = (0.5 * width - column - unit(&random)) * pixel_mm;
        const double y = (row + unit(&random) - 0.5 * height) * pixel_mm;
        const double r = opening * sqrt(unit(&random)), turn = 2.0 * kPi * unit(&random);
        double ray[9];
        if (!lens_ray(x, y, r * cos(turn), r * sin(turn), kLambda_nm, ray) || ray[7] > 1.0) continue;
        irradiance += radiance(ray, ray + 3) * ray[6] * ray[8];
      }
      irradiance *= kPi * opening * opening / rays;  // the opening's area, over the number of samples
      if (row == height / 2 && column == width / 2) middle = irradiance;
      const double level = 255.0 * pow(fmin(1.0, 2.0 * irradiance / (opening * opening)), 1.0 / 2.2);
      fputc((int)level, file);
    }
  }
  // The lamp's image lies where the ray through the middle of the stop lands; the one through the edge shows its blur.
  double at[2], edge[2];
  if (lens_sensor(300.0, 300.0, kLamps_mm, 1.0, 0.0, 0.0, kLambda_nm, at) &&
      lens_sensor(300.0, 300.0, kLamps_mm, 1.0, opening, 0.0, kLambda_nm, edge))
    printf("middle %.6g; lamp at %.4f, %.4f mm, radius of its blur %.4f mm\n", middle, at[0], at[1],
           hypot(edge[0] - at[0], edge[1] - at[1]));
  return fclose(file) == 0 ? 0 : 1;
}
