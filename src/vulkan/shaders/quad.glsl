// SPDX-License-Identifier: Apache-2.0
// Cells and blocks of cells on the frame: render/tiled/primitive_builder.cpp under the same names.
uint ray_at(uint ix, uint iy) { return p.first_ray + iy * p.side + ix; }
uvec4 corners_of(uint size, uint ix, uint iy) {
  return uvec4(ray_at(ix * size, iy * size), ray_at((ix + 1u) * size, iy * size),
               ray_at((ix + 1u) * size, (iy + 1u) * size), ray_at(ix * size, (iy + 1u) * size));
}
bool any_failed(uvec4 v) { return failed(rays[v.x]) || failed(rays[v.y]) || failed(rays[v.z]) || failed(rays[v.w]); }

bool is_convex(uvec4 v) {
  bool left = true, right = true;
  for (int k = 0; k < 4; ++k) {
    vec2 a = rays[v[k]].xy, b = rays[v[(k + 1) % 4]].xy, c = rays[v[(k + 2) % 4]].xy;
    float product = cross2(b - a, c - b);
    left = left && product > 0.0;
    right = right && product < 0.0;
  }
  return left || right;
}
