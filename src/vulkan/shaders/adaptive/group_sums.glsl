// SPDX-License-Identifier: Apache-2.0
// Sums over a workgroup of 256, of rows of four numbers by invocation; of the last row, the largest.
#define ROWS 4u
#define LARGEST_ROW 3u
shared vec4 rows[ROWS][256];

vec4 add_to_row(uint row, vec4 a, vec4 b) { return row == LARGEST_ROW ? max(a, b) : a + b; }

// In two steps: processors pass barriers slowly, and all invocations wait for a loop that is unrolled.
void sum_rows_in_steps() {
  uint t = gl_LocalInvocationIndex;
  for (uint step_by = 16u; step_by > 0u; step_by /= 16u) {
    uint row = t / step_by, lane = t % step_by;
    if (row < ROWS) {
      vec4 all = rows[row][lane];
      [[dont_unroll]] for (uint k = lane + step_by; k < 16u * step_by; k += step_by)
        all = add_to_row(row, all, rows[row][k]);
      rows[row][lane] = all;
    }
    barrier();
  }
}

// The sums, into rows[...][0].
void sum_rows() {
  barrier();
  if (ON_PROCESSOR) {
    sum_rows_in_steps();
    return;
  }
  uint t = gl_LocalInvocationIndex;
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    if (t < half_count)
      for (uint row = 0u; row < ROWS; ++row) rows[row][t] = add_to_row(row, rows[row][t], rows[row][t + half_count]);
    barrier();
  }
}
