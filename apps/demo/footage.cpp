// SPDX-License-Identifier: Apache-2.0
#include "demo/footage.h"

#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/output_file.h"
#include "contrejour/image_io.h"

namespace contrejour::demo {
namespace {

Result<void> write_text(const std::filesystem::path& name, const std::string& text) {
  auto file = OutputFile::create(name);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = file->write(text); !ok) return ok;
  return file->commit();
}

}  // namespace

Result<void> write_footage(const ShotSettings& settings, const std::filesystem::path& folder) {
  std::vector<std::vector<TrueLight>> lights;
  for (int frame = 0; frame < settings.frame_count; ++frame) {
    ShotFrame made = make_frame(settings, frame);
    const auto name = folder / fmt::format("plate.{:04}.exr", kFirstFrame + frame);
    if (auto ok = write_exr(name, made.image, SampleType::Half); !ok) return ok;
    lights.push_back(std::move(made.lights));
  }
  return write_text(folder / "true-lights.toml", write_animation(true_animation(settings, lights, kFirstFrame)));
}

}  // namespace contrejour::demo
