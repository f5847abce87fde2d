// SPDX-License-Identifier: Apache-2.0
// Everything that a program needs to render flare: lenses, lights, frames, renderers, pictures, presets, and flare
// added to photographs. Headers in contrejour/expert serve single parts: glasses and films, rays, diffraction,
// measurements.
#pragma once

#include "contrejour/apply.h"
#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "contrejour/frame_settings.h"
#include "contrejour/ghost_figures.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/image_view.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/method_options.h"
#include "contrejour/preset.h"
#include "contrejour/render.h"
#include "contrejour/renderer.h"
#include "contrejour/result.h"
