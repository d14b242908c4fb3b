// Formulas in the texts of pages.
#pragma once

#include <string>

namespace ropewalk {

// Text as HTML: a piece between backquotes becomes MathML, and all else is escaped as by escape_markup().
//
//   "`w = F L^3/(3 EI) + F L/kGA` (Timoshenko)"
//
// Factors stand side by side. `/` draws a fraction of the whole product before it, over the next factors up to a
// space, or over one bracket or function. `^` and `_` take one letter, number, word or bracket; digits after a
// letter, as in E90, are an index. Brackets that only group a numerator, a denominator or an exponent are not
// drawn. sqrt(...) is a root, `sum` a sum, |...| a magnitude, names of Greek letters are letters, and names of
// functions stand upright, as words do. Runs of up to two letters are products, as are EA, EI, GJ and kGA; d before
// a letter, as in dgamma, is that of a derivative. A piece that is no formula or one word alone, as in `auto`, is
// shown as code; never an error.
std::string with_formulas(const std::string& text);

}  // namespace ropewalk
