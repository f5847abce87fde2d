// A picture file as an iris.
#pragma once

#include <memory>
#include <string>

#include "contrejour/iris_field.h"
#include "contrejour/result.h"

namespace contrejour::params {

// The mean of the picture's red, green and blue says where light passes. Errors: those of reading a picture
// (image_io.h) and IrisField::from_levels; the file is named.
[[nodiscard]] Result<std::shared_ptr<const IrisField>> read_iris_image(const std::string& file);

}  // namespace contrejour::params
