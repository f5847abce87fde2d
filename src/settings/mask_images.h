// Picture files as what lies in the lens: its iris, its dirt. The mean of red, green and blue says where light passes.
// Errors: those of reading a picture (image_io.h) and of what is made of it; the file is named.
#pragma once

#include <memory>
#include <string>

#include "contrejour/dirt.h"
#include "contrejour/iris_field.h"
#include "contrejour/result.h"

namespace contrejour::params {

[[nodiscard]] Result<std::shared_ptr<const IrisField>> read_iris_image(const std::string& file);
[[nodiscard]] Result<std::shared_ptr<const DirtPicture>> read_dirt_image(const std::string& file);

}  // namespace contrejour::params
