// What tubes can be coloured by: in the page in space, in pictures and in movies.
#pragma once

#include <string>
#include <vector>

#include "io/log.hpp"
#include "report/view/view_page.hpp"
#include "run/pages/run_views.hpp"

namespace ropewalk {

// What every element has in every frame. Quantities that some frame lacks are left out.
std::vector<ViewField> element_fields(const StoredEvents& events, const std::vector<StoredFrame>& frames,
                                      const std::vector<LogRow>& log);
// Shell, and type where there are several, of the pieces of the tubes.
std::vector<ViewTubeNumber> tube_numbers(const Scene& scene, const Prepared& prepared, const Topology& pieces);

// The words of --colour.
std::vector<std::string> colour_words();
// Colours the views, which are those of the frames, by a quantity of these words. Throws InputError where the run
// does not have it.
void colour_by(const std::string& word, const StoredEvents& events, const std::vector<StoredFrame>& frames,
               const Scene& scene, const Prepared& prepared, std::vector<RopeView>& views);

}  // namespace ropewalk
