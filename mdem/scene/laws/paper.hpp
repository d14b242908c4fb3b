// law = "paper".
#pragma once

#include "model/contact/paper.hpp"

namespace ropewalk {

struct Scene;

PaperContact paper_contact(const Scene& scene);

}  // namespace ropewalk
