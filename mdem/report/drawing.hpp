// Drawings in other formats than SVG.
#pragma once

#include <string>

namespace ropewalk {

// Writes an SVG as "png" or "pdf" by librsvg's program, whole or not at all. zoom: pixels of a PNG to a unit of the
// drawing. Throws FileError, or another InputError where the program is missing or fails. `option`: of the command
// line, for the message.
void write_drawing(const std::string& path, const std::string& svg, const std::string& format, double zoom,
                   const char* option);

}  // namespace ropewalk
