// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "axial/base.h"
#include "base/log.h"
#include "base/progress.h"
