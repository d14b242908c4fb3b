// Files of this folder, and those of three.js, as text. CMake writes the source file.
#pragma once

namespace ropewalk {

extern const char* const view_body_html;
extern const char* const view_css;
extern const char* const view_js;         // frames.js, scene.js, camera.js and page.js as one script
extern const char* const three_js;        // empty: it was not there when this program was built
extern const char* const three_orbit_js;  // likewise

}  // namespace ropewalk
