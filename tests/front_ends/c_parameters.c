// SPDX-License-Identifier: Apache-2.0
// Prints the table of parameters as C programs get it, and what the value given as NAME=TEXT became.
#include <stdio.h>
#include <string.h>

#include <contrejour_optics.h>

static int fail(const cj_error* error) {
  fprintf(stderr, "%s\n", error->message);
  return 1;
}

int main(int count, char** arguments) {
  cj_error error = CJ_INIT(cj_error);
  cj_settings* settings = NULL;
  char text[100];
  size_t k;
  for (k = 0; k < cj_parameter_count(); ++k) {
    cj_parameter parameter = CJ_INIT(cj_parameter);
    if (cj_parameter_get(k, &parameter, &error) != CJ_OK) return fail(&error);
    printf("%s %d %g %g %s %s\n", parameter.name, (int)parameter.kind, parameter.minimum, parameter.maximum,
           parameter.unit, parameter.fallback);
  }
  if (cj_settings_create(&settings, &error) != CJ_OK) return fail(&error);
  if (count == 3) {
    if (cj_settings_set(settings, arguments[1], arguments[2], &error) != CJ_OK) return fail(&error);
    if (cj_settings_get(settings, arguments[1], 0, text, sizeof text, NULL, &error) != CJ_OK) return fail(&error);
    printf("set %s\n", text);
  }
  cj_settings_destroy(settings);
  return 0;
}
