// The largest numbers that a scene may ask for.
#pragma once

namespace ropewalk {

inline constexpr int max_elements = 10000000;  // elements in a scene: about 25 GB
inline constexpr double longest_time = 1e7;    // ps, that a key may name

}  // namespace ropewalk
