// SPDX-License-Identifier: Apache-2.0
// The sum of a number by invocation over a workgroup of 256, or the largest.
shared vec4 sums_of[256];

// The sum of sums_of[], or the largest by component, into sums_of[0], in two steps: processors pass barriers slowly,
// and all invocations wait for a loop that is unrolled.
void reduce_in_steps(bool takes_largest) {
  uint t = gl_LocalInvocationIndex;
  barrier();
  for (uint step_by = 16u; step_by > 0u; step_by /= 16u) {
    if (t < step_by) {
      vec4 all = sums_of[t];
      [[dont_unroll]] for (uint k = t + step_by; k < 16u * step_by; k += step_by) {
        vec4 one = sums_of[k];
        all = takes_largest ? max(all, one) : all + one;
      }
      sums_of[t] = all;
    }
    barrier();
  }
}

void sum_up() {
  if (ON_PROCESSOR) {
    reduce_in_steps(false);
    return;
  }
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    if (gl_LocalInvocationIndex < half_count)
      sums_of[gl_LocalInvocationIndex] += sums_of[gl_LocalInvocationIndex + half_count];
    barrier();
  }
}

void largest() {
  if (ON_PROCESSOR) {
    reduce_in_steps(true);
    return;
  }
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    if (gl_LocalInvocationIndex < half_count)
      sums_of[gl_LocalInvocationIndex] =
          max(sums_of[gl_LocalInvocationIndex], sums_of[gl_LocalInvocationIndex + half_count]);
    barrier();
  }
}
