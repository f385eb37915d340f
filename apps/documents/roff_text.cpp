// SPDX-License-Identifier: BSD-3-Clause
#include "roff_text.h"

#include <map>

namespace psi_slam {

std::string roff_text(std::string_view text) {
  static const std::map<char, const char*> kEscapes{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                    {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"},
                                                    {'"', "\\(dq"}};
  std::string roff;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) roff += "\\&";
    line_begins = c == '\n';
    const auto escape = kEscapes.find(c);
    roff += escape == kEscapes.end() ? std::string(1, c) : escape->second;
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
