// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/private/opencv_codecs.h"

#include <dlfcn.h>

#include <opencv2/imgcodecs.hpp>

#include "base/error.h"

namespace axial::io {

namespace {

// The name of the library that the build found, such as libopencv_imgcodecs.so.406.
constexpr const char* kLibrary = AXIAL_IMAGE_CODECS;

using Decode = cv::Mat(cv::InputArray, int);
using Encode = bool(const cv::String&, cv::InputArray, std::vector<uchar>&,
                    const std::vector<int>&);

// Returns the function of the library with this symbol. The symbols are those of the Itanium C++
// ABI for the declarations in opencv2/imgcodecs.hpp.
template <class Function>
Function* codec(const char* symbol) {
  static void* const library = dlopen(kLibrary, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) fail_in(kLibrary, "cannot be loaded: {}", dlerror());
  void* const found = dlsym(library, symbol);
  if (found == nullptr) fail_in(kLibrary, "has no {}", symbol);
  return reinterpret_cast<Function*>(found);
}

}  // namespace

cv::Mat decode_by_opencv(std::string_view bytes, int flags) {
  static Decode* const decode = codec<Decode>("_ZN2cv8imdecodeERKNS_11_InputArrayEi");
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  return decode(raw, flags);
}

std::vector<unsigned char> encode_by_opencv(const std::string& extension, const cv::Mat& image,
                                            const std::vector<int>& parameters) {
  static Encode* const encode = codec<Encode>(
      "_ZN2cv8imencodeERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_InputArrayE"
      "RSt6vectorIhSaIhEERKSB_IiSaIiEE");
  std::vector<unsigned char> bytes;
  if (!encode(extension, image, bytes, parameters)) return {};
  return bytes;
}

}  // namespace axial::io
