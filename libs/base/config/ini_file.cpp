// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/ini_file.h"

#include <iomanip>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/file_bytes.h"
#include "base/quotable_text.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSpace = " \t\r\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kInclude = "include";
constexpr std::size_t kMostMebibytes = 16;  // of a file; settings files have a few kilobytes

std::string_view stripped(std::string_view text) {
  return trimmed(text, kSpace);
}

bool is_space(char c) {
  return kSpace.find(c) != std::string_view::npos;
}

bool begins_comment(std::string_view text, std::size_t i) {
  if (text[i] == ';') return true;
  if (i > 0 && !is_space(text[i - 1])) return false;
  return text[i] == '#' || text.substr(i, 2) == "//";
}

std::string_view without_comment(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (begins_comment(text, i)) return text.substr(0, i);
  return text;
}

bool is_blank(std::string_view text) {
  return stripped(without_comment(text)).empty();
}

/// Reads a file. Sets `failure` to the reason if the file is not readable.
std::string contents(const fs::path& path, std::string& failure) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    failure = "it is a folder";
    return {};
  }
  try {
    constexpr std::size_t kMostBytes = kMostMebibytes << 20;
    std::string bytes = file_bytes(path, kMostBytes);
    if (bytes.size() <= kMostBytes) return bytes;
    failure = "it has more than " + std::to_string(kMostMebibytes) +
              " MiB, expected a file of settings. Name another file";
    return {};
  } catch (const std::system_error& error) {
    failure = error.code().message();
    return {};
  }
}

/// Canonical path of a file, to recognise the same file under different paths.
fs::path identity(const fs::path& path) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path.lexically_normal() : canonical;
}

/// Parses the value of a "key = value" line and removes its quotes. Throws UserError for malformed quotes.
std::string parse_value(std::string_view text, const std::string& where) {
  text = stripped(text);
  if (text.empty() || text[0] != '"') return std::string(stripped(without_comment(text)));
  std::string value;
  std::size_t i = 1;
  for (; i < text.size() && text[i] != '"'; ++i) {
    if (text[i] == '\\') {
      ++i;
      if (i == text.size() || (text[i] != '"' && text[i] != '\\'))
        throw UserError(where + R"(: a backslash in quotes is written \\, and a quote \")");
    }
    value += text[i];
  }
  if (i == text.size()) throw UserError(where + ": the closing quote is missing");
  if (!is_blank(text.substr(i + 1)))
    throw UserError(where + ": expected the end of the line after the closing quote");
  return value;
}

/// Parses the name in "[name]", which a comment can follow. Throws UserError for any other text.
std::string parse_heading(std::string_view line, const std::string& where) {
  const std::size_t end = line.find(']');
  if (end == std::string_view::npos || stripped(line.substr(1, end - 1)).empty() ||
      !is_blank(line.substr(end + 1)))
    throw UserError(where + ": expected [section], not " + quotable(line));
  return std::string(stripped(line.substr(1, end - 1)));
}

/// Reads a file and the files that it includes.
class Reader {
 public:
  explicit Reader(IniFile& result) : result_(result) {}

  void read(std::string_view text, const fs::path& path) {
    open_files_.push_back(path);
    Position position{path, 0, {}, {}};
    if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = stripped(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++position.line;
      if (is_blank(line)) continue;
      if (line[0] == '[') {
        position.section = parse_heading(line, position.where());
        result_.sections.push_back({*position.section, position.where()});
      } else {
        read_assignment(line, position);
      }
    }
    open_files_.pop_back();
  }

 private:
  /// Current position in one file.
  struct Position {
    fs::path path;
    int line = 0;
    std::optional<std::string> section;
    std::map<std::pair<std::string, std::string>, int> line_of_key;

    std::string where() const { return path.string() + ':' + std::to_string(line); }
  };

  void read_assignment(std::string_view line, Position& position) {
    const std::string where = position.where();
    const std::size_t equals = line.find('=');
    const std::string key(stripped(line.substr(0, equals)));
    if (equals == std::string_view::npos || key.empty())
      throw UserError(where + ": expected key = value or [section], not " + quotable(line));
    const std::string value = parse_value(line.substr(equals + 1), where);
    if (key == kInclude) {
      if (position.section) throw UserError(where + ": include must precede the first section");
      include(value, position);
      return;
    }
    if (!position.section)
      throw UserError(where + ": \"" + quotable(key) + "\" precedes the first [section]");
    const auto [first, is_new] = position.line_of_key.try_emplace({*position.section, key}, position.line);
    if (!is_new) {
      throw UserError(where + ": \"" + quotable(key) + "\" in [" + quotable(*position.section) +
                      "] is given twice, first in line " + std::to_string(first->second) + "; keep one");
    }
    result_.values.push_back({*position.section, key, value, where});
  }

  void include(const std::string& name, const Position& from) {
    if (name.empty()) throw UserError(from.where() + ": include needs the name of a file");
    constexpr std::size_t kMostBytesOfPath = 1000;
    const fs::path path = (from.path.parent_path() / name).lexically_normal();
    std::string chain;
    for (const fs::path& open_file : open_files_)
      if (!chain.empty() || identity(open_file) == identity(path)) chain += open_file.string() + " -> ";
    if (!chain.empty())
      throw UserError(from.where() + ": a file cannot include itself: " + chain + path.string());
    std::string failure;
    const std::string text = contents(path, failure);
    if (!failure.empty())
      throw UserError(from.where() + ": cannot read the included file " +
                      quotable(path.string(), kMostBytesOfPath) + ": " + failure);
    read(text, path);
  }

  IniFile& result_;
  std::vector<fs::path> open_files_;  ///< files that are being read, outermost first
};

}  // namespace

IniFile read_ini(const fs::path& path) {
  std::string failure;
  const std::string text = contents(path, failure);
  if (!failure.empty()) throw UserError("cannot read " + path.string() + ": " + failure);
  return parse_ini(text, path);
}

IniFile parse_ini(std::string_view text, const fs::path& path) {
  IniFile result;
  Reader(result).read(text, path);
  return result;
}

std::string ini_value_text(const std::string& text) {
  const bool is_plain = !text.empty() && text[0] != '"' && stripped(without_comment(text)) == text;
  if (is_plain) return text;
  std::ostringstream quoted;
  quoted << std::quoted(text);
  return quoted.str();
}

}  // namespace psi_slam
