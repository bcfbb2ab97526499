# SPDX-License-Identifier: GPL-3.0-or-later
# Turns the plain comments of a header into comments of Doxygen, for docs/Doxyfile (sed -E -f).
# Line numbers stay the same.

# The comment after the licence line describes the file.
/^\/\/ SPDX/ {
  s|.*|/// @file|
  b
}
# A comment on lines of its own belongs to the declaration after it. Characters that start commands
# and tags of Doxygen are escaped, except in indented code.
/^ *\/\/([^/]|$)/ {
  /^ *\/\/     /!s/([\\@<>])/\\\1/g
  s|//|///|
  b
}
# A comment behind a declaration belongs to this declaration.
s|([^ ].*[^ ]) +// |\1 ///< |
