// SPDX-License-Identifier: GPL-3.0-or-later
// Empty: the library around parsed headers needs a file.
