// Why the loop of a run came to an end.
#pragma once

namespace ropewalk {

enum class StopReason { none, complete, asked, limit, refine, wall_time };

}  // namespace ropewalk
