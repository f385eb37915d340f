// SPDX-License-Identifier: BSD-3-Clause
#include "common/svg_parts.h"

#include "report/html_text.h"
#include "base/number_text.h"

namespace psi_slam {

std::string svg_text(double x, double y, const std::string& attributes, const std::string& content) {
  return "<text x=\"" + fixed_text(x, 1) + "\" y=\"" + fixed_text(y, 1) + "\" " + attributes + '>' +
         escape_html(content) + "</text>\n";
}

std::string svg_page(double width, double height, const std::string& content) {
  const std::string size = fixed_text(width, 0) + ' ' + fixed_text(height, 0);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" +
         fixed_text(width, 0) + "\" height=\"" + fixed_text(height, 0) +
         "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#333\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         content + "</svg>\n";
}

}  // namespace psi_slam
