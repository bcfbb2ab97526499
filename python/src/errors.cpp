// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/base.h"
#include "src/bind.h"

namespace axial::python {
namespace {

// The words of Python for settings whose names in the libraries are no keywords.
const SettingNames& keywords() {
  static const SettingNames names{{"fusion.min_views", "min_views"},
                                  {"make_maps false", "make_maps=False"},
                                  {"camera is flat_port", "ports='flat'"},
                                  {"refractive", "ports='required'"},
                                  {"overwrite_dmaps true", "overwrite_dmaps=True"},
                                  {"estimate_colors 1", "estimate_colors=1"},
                                  {"estimate_normals 1", "estimate_normals=1"}};
  return names;
}

std::string keyword(const std::string& setting) {
  const auto found = keywords().find(setting);
  return found == keywords().end() ? setting : found->second;
}

// axialmvs.Error with the parts of `error`.
void raise(const Error& error) {
  const py::object type = py::module_::import("axialmvs._axialmvs").attr("Error");
  const py::str text = text_of_file_system(in_words(error.text(), keywords()));
  const py::object raised = type(text);
  raised.attr("text") = text;
  raised.attr("file") = text_of_file_system(error.file().string());
  raised.attr("setting") = keyword(error.setting());
  PyErr_SetObject(type.ptr(), raised.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    raise(error);
  }
}

}  // namespace

py::str text_of_file_system(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "surrogateescape"));
}

void bind_errors(py::module_& module) {
  const py::object type = py::exception<Error>(module, "Error", PyExc_RuntimeError);
  type.attr("__doc__") =
      "A fault of a file, of a value or of an option. The message is one line.\n\n"
      "text: the message. file: the file, or the place in a file, with which the message begins,\n"
      "or ''. setting: the keyword with which the message begins, or ''.";
  for (const char* name : {"text", "file", "setting"}) type.attr(name) = "";
  py::register_exception<Stopped>(module, "Stopped").attr("__doc__") =
      "A stage ended before its work was done, because the function `progress` returned False.";
  py::register_exception_translator(translate);
}

}  // namespace axial::python
