// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/embree_errors.h"

#include "base/error.h"

namespace axial::geometry {

void require_no_error(RTCDevice device, std::size_t faces) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    fail("there is not enough memory to search the mesh, which has {} faces", faces);
  fail("the mesh cannot be searched (error {} of the ray tracer)", static_cast<int>(error));
}

}  // namespace axial::geometry
