// SPDX-License-Identifier: BSD-3-Clause
// Reads settings files:
//
//     include = usual.ini        ; before the first section; this file overrides values of usual.ini
//     [front_end]
//     window_m = 0.15            // a comment
//     label = "a ; b \"c\" \\"  # quotes keep all characters; inside, \" means " and \\ means a backslash
//
// Comments begin with ';' anywhere, or with '#' or '//' at the start of a line or value or after a space.
// Names are case-sensitive. A section can continue later in the file, but a key must not be given twice in
// one file. Files are UTF-8, with or without byte order mark; lines end in LF or CRLF.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

/// Heading of a section in a file.
struct IniSection {
  std::string name;
  std::string where;  ///< file and line: "my.ini:12"
};

/// A value in a file, from a line "key = value".
struct IniValue {
  std::string section;
  std::string key;
  std::string text;   ///< value without quotes
  std::string where;  ///< file and line: "my.ini:12"
};

/// Sections and values in the order in which they take effect: an included file comes before the file that
/// includes it.
struct IniFile {
  std::vector<IniSection> sections;
  std::vector<IniValue> values;
};

/// Reads a settings file. Names of included files are relative to the folder of the including file. Throws
/// UserError with file and line for a malformed line, a key given twice, and an included file that is not
/// readable or includes itself. Throws UserError with the file name if `path` is not readable.
IniFile read_ini(const std::filesystem::path& path);

/// Parses a text as the contents of a file called `path`. Throws like read_ini().
IniFile parse_ini(std::string_view text, const std::filesystem::path& path);

/// Returns `text` as the value of a "key = value" line, quoted if necessary. `text` must be one line.
std::string ini_value_text(const std::string& text);

}  // namespace psi_slam
