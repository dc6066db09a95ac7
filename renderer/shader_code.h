#pragma once
// The compiled shaders. Include in one .cpp per shader: the arrays are constants of that file.

#include <cstdint>

namespace touchstone::shaders {
#include "shaders/background_frag.h"
#include "shaders/background_kept_frag.h"
#include "shaders/false_color_frag.h"
#include "shaders/false_color_vert.h"
#include "shaders/full_screen_vert.h"
#include "shaders/kept_shadow_frag.h"
#include "shaders/overlay_frag.h"
#include "shaders/overlay_line_frag.h"
#include "shaders/overlay_line_vert.h"
#include "shaders/overlay_vert.h"
#include "shaders/scene_frag.h"
#include "shaders/scene_glass_frag.h"
#include "shaders/scene_kept_frag.h"
#include "shaders/scene_kept_points_frag.h"
#include "shaders/scene_lines_vert.h"
#include "shaders/scene_points_frag.h"
#include "shaders/scene_points_vert.h"
#include "shaders/scene_program_frag.h"
#include "shaders/scene_program_kept_frag.h"
#include "shaders/scene_program_vert.h"
#include "shaders/scene_vert.h"
#include "shaders/window_frag.h"
#include "shaders/wireframe_frag.h"
#include "shaders/wireframe_vert.h"
} // namespace touchstone::shaders
