// SPDX-License-Identifier: Apache-2.0
// The plug-in in a host, as a program:
//   openfx_program list                                   its parameters
//   openfx_program render WIDTH HEIGHT FILE.pfm NAME=TEXT...   a picture of its generator
// The variable CONTREJOUR_OPENFX_PLUGIN names another plug-in than that of the build.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include "test_host.h"

using namespace contrejour::openfx;

namespace {

int list() {
  const TestHost host;
  const auto described = host.describe(context::kGenerator);
  for (const auto& param : described->params.params) {
    const PropertySetStruct& p = param->properties;
    std::printf("%s %s", param->name.c_str(), param->type.c_str());
    if (param->type == type::kDouble)
      std::printf(" %g %g %g", p.get<double>(name::kMin), p.get<double>(name::kMax), p.get<double>(name::kDefault));
    std::printf("\n");
  }
  return 0;
}

void set(EffectStruct& effect, const std::string& given) {
  const std::size_t equals = given.find('=');
  const std::string script = given.substr(0, equals), text = given.substr(equals + 1);
  const ParamStruct& param = effect.param(script);
  if (param.type == type::kString) {
    effect.set_text(script, text);
  } else if (param.type == type::kChoice) {
    effect.choose(script, text);
  } else {
    effect.set(script, {text == "on" ? 1.0 : text == "off" ? 0.0 : std::stod(text)});
  }
}

int render(int count, char** arguments) {
  const int width = std::atoi(arguments[2]), height = std::atoi(arguments[3]);
  const TestHost host;
  const auto effect = host.create(context::kGenerator, width, height);
  HostPicture output = HostPicture::of({0, 0, width, height});
  effect->clip(clip::kOutput)->picture = &output;
  for (int k = 5; k < count; ++k) set(*effect, arguments[k]);
  const auto status = host.render(*effect, {.window = output.bounds});
  if (status != status::kOk || !effect->message.empty()) {
    std::fprintf(stderr, "status %d: %s\n", status, effect->message.c_str());
    return 1;
  }
  std::ofstream file(arguments[4], std::ios::binary);
  file << "PF\n" << width << " " << height << "\n-1.0\n";  // rows from the bottom up, as the host's
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const float sample = output.at(x, y, c);
        file.write(reinterpret_cast<const char*>(&sample), sizeof sample);
      }
  host.destroy(*effect);
  return file.good() ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count == 2 && std::strcmp(arguments[1], "list") == 0) return list();
    if (count >= 5 && std::strcmp(arguments[1], "render") == 0) return render(count, arguments);
  } catch (const std::exception& thrown) {
    std::fprintf(stderr, "%s\n", thrown.what());
    return 1;
  }
  std::fprintf(stderr, "usage: openfx_program list | render WIDTH HEIGHT FILE.pfm NAME=TEXT...\n");
  return 2;
}
