// SPDX-License-Identifier: BSD-3-Clause
// Checks that the tags of an HTML page or SVG drawing are well formed.
#pragma once

#include <cctype>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace psi_slam {

/// The text without all parts from `begin` to the next `end`, inclusive.
inline std::string without(std::string text, const std::string& begin, const std::string& end) {
  for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;)
    text.erase(at, text.find(end, at + begin.size()) + end.size() - at);
  return text;
}

/// Parses the tag whose '<' is at the index `at`.
class Tag {
 public:
  Tag(const std::string& html, std::size_t at) : html_(html), at_(at + 1) {
    closing_ = take('/');
    name_ = word();
    well_formed_ = !name_.empty();
    while (well_formed_ && take(' ')) attribute();
    empty_ = take('/');
    well_formed_ = well_formed_ && take('>');
  }

  bool well_formed() const { return well_formed_; }
  bool closing() const { return closing_; }
  bool empty() const { return empty_; }
  const std::string& name() const { return name_; }
  std::size_t end() const { return at_; }

 private:
  bool take(char c) {
    if (at_ >= html_.size() || html_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string word() {
    const std::size_t begin = at_;
    while (at_ < html_.size() && (std::isalnum(static_cast<unsigned char>(html_[at_])) != 0 ||
                                  html_[at_] == '-' || html_[at_] == '!'))
      ++at_;
    return html_.substr(begin, at_ - begin);
  }

  void attribute() {
    well_formed_ = !word().empty();
    if (!take('=')) return;
    well_formed_ = well_formed_ && take('"');
    while (at_ < html_.size() && html_[at_] != '"' && html_[at_] != '<') ++at_;
    well_formed_ = well_formed_ && take('"');
  }

  const std::string& html_;
  std::size_t at_;
  std::string name_;
  bool closing_ = false;
  bool empty_ = false;
  bool well_formed_ = false;
};

/// True if `text`, found between two tags, contains no unescaped HTML character.
inline bool is_escaped(const std::string& text) {
  if (text.find_first_of("<>") != std::string::npos) return false;
  for (std::size_t at = 0; (at = text.find('&', at)) != std::string::npos; ++at) {
    bool entity = false;
    for (const char* known : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"})
      entity = entity || text.compare(at, std::string(known).size(), known) == 0;
    if (!entity) return false;
  }
  return true;
}

/// Description of the first error. Empty if all tags are closed in order, attributes are quoted, and no '&',
/// '<' or '>' is unescaped.
inline std::string complaint_about(const std::string& html) {
  const std::set<std::string> unpaired = {"meta", "input", "!DOCTYPE"};
  std::vector<std::string> open;
  std::size_t text_begin = 0;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', text_begin)) {
    if (!is_escaped(html.substr(text_begin, at - text_begin)))
      return "bare sign in: " + html.substr(text_begin, 80);
    const Tag tag(html, at);
    if (!tag.well_formed()) return "broken tag: " + html.substr(at, 80);
    text_begin = tag.end();
    if (tag.empty() || unpaired.count(tag.name()) > 0) continue;
    if (!tag.closing()) {
      open.push_back(tag.name());
    } else if (open.empty() || open.back() != tag.name()) {
      return "</" + tag.name() + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

}  // namespace psi_slam
