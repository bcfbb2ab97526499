// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the image codecs of OpenCV. Their library is loaded at the first call. It
// loads a hundred other libraries (GDAL and its formats), which takes 0.15 s and 40 MB, and most
// runs of a program do not need a codec.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/private/only_for_io.h"

namespace axial::io {

// As cv::imdecode() and cv::imencode(). The image is empty if the bytes cannot be decoded, and
// there are no bytes if the image cannot be encoded. Both functions also throw cv::Exception. Error
// if the library is not installed or cannot be loaded.
cv::Mat decode_by_opencv(std::string_view bytes, int flags);
std::vector<unsigned char> encode_by_opencv(const std::string& extension, const cv::Mat& image,
                                            const std::vector<int>& parameters);

}  // namespace axial::io
