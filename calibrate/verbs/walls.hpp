// The walls that `ropewalk calibrate` is asked for.
#pragma once

#include <string>
#include <vector>

#include "model/tube.hpp"

namespace ropewalk::calibrate {

// "(5,5)@(10,10)" or "5,5@10,10", inside first; "10,10" is one wall. Throws InputError for what is no chirality, and for
// neighbours that are nearer than least_wall_spacing or farther apart than most_wall_spacing (walls.hpp).
std::vector<Chirality> parse_walls(const std::string& text);

// Armchair and zigzag walls whose distances are nearest to that of graphite, and whose outer diameter (nm) is near the
// one that is wanted.
std::vector<Chirality> find_walls(int walls, double outer_diameter);

// "(5,5)@(10,10)"
std::string walls_text(const std::vector<Chirality>& walls);
// "(5,5)@(10,10): 1.356 nm wide, walls 0.339 nm apart"
std::string walls_summary(const std::vector<Chirality>& walls);

// Whether walls lock, so that by default all carry: all are armchair or all are zigzag, and have one period.
bool walls_lock(const std::vector<Chirality>& walls);

}  // namespace ropewalk::calibrate
