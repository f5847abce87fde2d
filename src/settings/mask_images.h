// SPDX-License-Identifier: Apache-2.0
// Reads picture files as an iris or as dirt: the mean of red, green and blue is the transmittance. Errors: those of
// reading a picture (image_io.h) and of making the iris or dirt from it; the message names the file.
#pragma once

#include <memory>
#include <string>

#include "contrejour/expert/dirt.h"
#include "contrejour/expert/iris_field.h"
#include "contrejour/result.h"

namespace contrejour::params {

[[nodiscard]] Result<std::shared_ptr<const IrisField>> read_iris_image(const std::string& file);
[[nodiscard]] Result<std::shared_ptr<const DirtPicture>> read_dirt_image(const std::string& file);

}  // namespace contrejour::params
