// SPDX-License-Identifier: Apache-2.0
// Sums in 64-bit fixed point, as two words: integer addition does not depend on the order, so that the picture is the
// same bits from run to run although many invocations add to a pixel at once.
#define LARGEST_SUM 1.0e18  // bounds a single value, far above any sum of a frame

// Two's complement of a value, rounded, low word first. Halves of a float's 24 digits are exact.
uvec2 to_fixed(float value) {
  float size = floor(min(abs(value), LARGEST_SUM) + 0.5);
  uint high = uint(size * 2.3283064365386963e-10);
  uint low = uint(size - float(high) * 4294967296.0);
  if (value >= 0.0) return uvec2(low, high);
  return uvec2(~low + 1u, ~high + (low == 0u ? 1u : 0u));
}

float from_fixed(uint low, uint high) {
  bool negative = (high & 0x80000000u) != 0u;
  if (negative) {
    low = ~low + 1u;
    high = ~high + (low == 0u ? 1u : 0u);
  }
  float size = float(high) * 4294967296.0 + float(low);
  return negative ? -size : size;
}

uvec2 add_words(uvec2 a, uvec2 b) {
  uint carry;
  uint low = uaddCarry(a.x, b.x, carry);
  return uvec2(low, a.y + b.y + carry);
}

uvec2 times_words(uvec2 a, uint factor) {
  uint high, low;
  umulExtended(a.x, factor, high, low);
  return uvec2(low, a.y * factor + high);
}

void add_fixed(uint at, uvec2 value) {
  if ((value.x | value.y) == 0u) return;
  uint before = atomicAdd(sums[at], value.x);
  uint carry = before > ~value.x ? 1u : 0u;
  if (value.y + carry != 0u) atomicAdd(sums[at + 1u], value.y + carry);
}
