// SPDX-License-Identifier: BSD-3-Clause
#include "roff_text.h"

namespace psi_slam {

std::string roff_text(std::string_view text) {
  std::string roff;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) roff += "\\&";
    line_begins = c == '\n';
    switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";
        break;
      case '\'':
        roff += "\\(aq";
        break;
      case '`':
        roff += "\\(ga";
        break;
      case '^':
        roff += "\\(ha";
        break;
      case '~':
        roff += "\\(ti";
        break;
      case '"':
        roff += "\\(dq";
        break;
      default:
        roff += c;
    }
  }
  return roff;
}

std::string roff_bold(std::string_view text) {
  return "\\fB" + roff_text(text) + "\\fR";
}

std::string roff_italic(std::string_view text) {
  return "\\fI" + roff_text(text) + "\\fR";
}

std::string roff_section(std::string_view title) {
  return ".SH \"" + roff_text(title) + "\"\n";
}

std::string roff_item(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + '\n' + text + '\n';
}

std::string roff_example(std::string_view text) {
  return ".PP\n.RS 4\n.nf\n" + roff_text(text) + (text.empty() || text.back() != '\n' ? "\n" : "") +
         ".fi\n.RE\n";
}

}  // namespace psi_slam
