#pragma once

namespace ropewalk {

enum class FrameFormat { gsd, dump };

}  // namespace ropewalk
