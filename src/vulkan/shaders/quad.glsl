// SPDX-License-Identifier: Apache-2.0
// Cells and blocks of cells on the frame: render/tiled/primitive_builder.cpp under the same names.
uint first_ray;  // of the invocation's grid

uint ray_at(uint ix, uint iy) { return first_ray + iy * p.side + ix; }
uvec4 corners_of(uint size, uint ix, uint iy) {
  return uvec4(ray_at(ix * size, iy * size), ray_at((ix + 1u) * size, iy * size),
               ray_at((ix + 1u) * size, (iy + 1u) * size), ray_at(ix * size, (iy + 1u) * size));
}
float block_at(uint k) { return texelFetch(block_texels, int(k)).x; }
bool any_failed(uvec4 v) {
  return failed(ray_of(v.x)) || failed(ray_of(v.y)) || failed(ray_of(v.z)) || failed(ray_of(v.w));
}

bool is_convex(uvec4 v) {
  bool left = true, right = true;
  for (int k = 0; k < 4; ++k) {
    vec2 a = ray_of(v[k]).xy, b = ray_of(v[(k + 1) % 4]).xy, c = ray_of(v[(k + 2) % 4]).xy;
    float product = cross2(b - a, c - b);
    left = left && product > 0.0;
    right = right && product < 0.0;
  }
  return left || right;
}
