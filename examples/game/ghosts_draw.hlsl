// SPDX-License-Identifier: Apache-2.0
// Draws one ghost of a light at one wavelength as a grid of cells, from polynomials:
//
//     contrejour polynomial fit heliar -o heliar.poly
//     contrejour polynomial export heliar.poly --count 5 -o ghosts.hlsl
//
// Draw instanced without vertex buffers: 6 GRID GRID vertices, one instance a ghost and colour; blend by adding. Light,
// sensor and stop are in mm and in tangents, as docs/polynomial-export.md says.
#include "ghosts.hlsl"

#define GRID 32

cbuffer Flare : register(b0) {
  float2 light_tangent;      // the light's direction from the camera, (x, y, -1): x right, y up
  float2 sensor_half_mm;     // half the width and the height of the picture on the sensor
  float stop_radius;         // of the opening, over the widest one
  int blades;                // of the iris; 0: round
  float blade_rotation;      // radians
  float pixel_flux;          // what the light's own image sums to, times a pixel's area (mm^2) over the flux that the
                             // lens takes in for an irradiance of 1 (mm^2)
  float4 colours[3];         // of the wavelengths, which sum to white: x, y, z; wavelength in nm: w
};

struct Corner {
  float4 position : SV_Position;
  float3 light : COLOR0;                     // by pixel, without what blocks it
  float2 stop : TEXCOORD0;
  float squared_height : TEXCOORD1;
};

struct FlareRay {
  float2 sensor_mm, stop;
  float squared_height, transmittance;
};

FlareRay ray_through(int ghost, float field, float2 entrance_mm, float lambda_nm) {
  float r[10];
  flare_ray(ghost, field, entrance_mm.x, entrance_mm.y, lambda_nm, r);
  FlareRay ray;
  ray.sensor_mm = float2(r[0], r[1]);
  ray.stop = float2(r[2], r[3]);
  ray.squared_height = r[8];
  ray.transmittance = max(r[9], 0.0);
  return ray;
}

Corner vertex_main(uint vertex : SV_VertexID, uint instance : SV_InstanceID) {
  Corner corner = (Corner)0;
  int ghost = int(instance) / 3;
  float4 colour = colours[int(instance) % 3];
  float field = length(light_tangent), box[3];
  if (!flare_bounds(ghost, field, box)) return corner;  // all corners in one point: nothing is drawn

  // The corner's point of the entrance plane, in the frame in which the light comes from -x.
  int cell = int(vertex) / 6, part = int(vertex) % 6;
  int2 at = int2(cell % GRID, cell / GRID) + int2(part == 1 || part == 2 || part == 4, part == 2 || part == 4 || part == 5);
  float2 low = float2(box[0], -box[2]), size = float2(box[1] - box[0], 2.0 * box[2]);
  float2 step = size / GRID, entrance = low + step * float2(at);
  FlareRay ray = ray_through(ghost, field, entrance, colour.w);

  // How a small area of the entrance plane is enlarged on the sensor: light is spread over as much.
  float2 tiny = 0.02 * step;
  float2 along_x = ray_through(ghost, field, entrance + float2(tiny.x, 0.0), colour.w).sensor_mm - ray.sensor_mm;
  float2 along_y = ray_through(ghost, field, entrance + float2(0.0, tiny.y), colour.w).sensor_mm - ray.sensor_mm;
  float enlarged = abs(along_x.x * along_y.y - along_x.y * along_y.x) / (tiny.x * tiny.y);
  float cosine = rsqrt(1.0 + field * field);
  corner.light = colour.xyz * (pixel_flux * cosine * ray.transmittance / max(enlarged, 1e-4));

  // Back to the camera's frame: the light travels to -light_tangent. A camera turns its picture upright.
  float2 x_axis = field > 0.0 ? -light_tangent / field : float2(1.0, 0.0), y_axis = float2(-x_axis.y, x_axis.x);
  float2 sensor_mm = x_axis * ray.sensor_mm.x + y_axis * ray.sensor_mm.y;
  corner.position = float4(-sensor_mm / sensor_half_mm, 0.0, 1.0);
  corner.stop = x_axis * ray.stop.x + y_axis * ray.stop.y;
  corner.squared_height = ray.squared_height;
  return corner;
}

// How far a point lies inside the iris, over its radius; below 0: outside.
float inside_iris(float2 at) {
  float distance = length(at);
  if (blades > 0) {
    float sector = 6.2831853 / float(blades), angle = atan2(at.y, at.x) - blade_rotation;
    angle -= sector * floor(angle / sector) + 0.5 * sector;
    distance *= cos(angle) / cos(0.5 * sector);
  }
  return 1.0 - distance / stop_radius;
}

float4 pixel_main(Corner corner) : SV_Target {
  // Edges one pixel wide.
  float iris = inside_iris(corner.stop), rim = 1.0 - corner.squared_height;
  float open = saturate(0.5 + iris / max(fwidth(iris), 1e-6)) * saturate(0.5 + rim / max(fwidth(rim), 1e-6));
  return float4(corner.light * open, 1.0);
}
