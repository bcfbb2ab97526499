// SPDX-License-Identifier: GPL-3.0-or-later
// Every header in a folder private/ of this library includes this file. The include directory that
// leads to it is set only for libs/io and for tests that name PRIVATE_OF io in their
// CMakeLists.txt. Other code that includes one of the headers does not compile.
#pragma once
