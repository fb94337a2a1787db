/// Text inside of Markdown that others will show, such as a pull request's comment.
#pragma once

#include <string>

namespace tarmac::reports {

/// A cell's or a line's text: nothing in it ends the cell or the line, opens markup or HTML, or names somebody.
std::string markdown_cell(const std::string& text);

}  // namespace tarmac::reports
