// SPDX-License-Identifier: GPL-3.0-or-later
// Every header in this folder includes this one. Only libs/io, and the tests that ask for it, have
// the include directory in which it is found. Anywhere else the headers do not compile.
#pragma once
