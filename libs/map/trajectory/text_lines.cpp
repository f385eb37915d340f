// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/text_lines.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/number_text.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t\r\n\v\f";

void split(std::string_view text, std::vector<std::string_view>& words) {
  words.clear();
  text = text.substr(0, text.find('#'));
  std::size_t begin = 0;
  while ((begin = text.find_first_not_of(kBlanks, begin)) != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end;
  }
}

/// Quotes at most 40 characters of a word for an error message and replaces those that are not printable.
std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string shown(word.substr(0, kLongest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return "'" + shown + (word.size() > kLongest ? "...'" : "'");
}

}  // namespace

UserError TextLine::error(const std::string& complaint) const {
  return UserError(path.string() + ":" + std::to_string(number) + ": " + complaint);
}

double TextLine::finite_number(std::size_t i, const char* what) const {
  const std::optional<double> value = parse_number(words.at(i));
  if (!value)
    throw error("expected " + std::string(what) + ", a finite number, as word " + std::to_string(i + 1) +
                ", found " + quoted(words[i]));
  return *value;
}

TimeUs TextLine::time(std::size_t i) const {
  const auto time_us = parse_seconds(words.at(i));
  if (!time_us)
    throw error("expected a time stamp in seconds as word " + std::to_string(i + 1) + ", found " +
                quoted(words[i]));
  return *time_us;
}

void for_each_text_line(const fs::path& path, const std::function<void(const TextLine&)>& visit) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw UserError("cannot read " + path.string() + ": it is a folder, not a file. Name a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw UserError("cannot read " + path.string() + ": " +
                    (errno != 0 ? std::strerror(errno) : "it cannot be opened"));
  std::string text;
  TextLine line{path, 0, {}};
  while (std::getline(file, text)) {
    ++line.number;
    split(text, line.words);
    if (!line.words.empty()) visit(line);
  }
  if (file.bad())
    throw SystemFailure("cannot read " + path.string() + ": reading failed part-way through. Check the disk");
}

}  // namespace psi_slam
