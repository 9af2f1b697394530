#include "tassilo/base/error.h"

#include "bindings.h"

namespace tassilo::python {

std::string shown(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>() + " of " + py::str(array.dtype()).cast<std::string>();
}

}  // namespace tassilo::python

PYBIND11_MODULE(_tassilo, module) {
  using namespace tassilo::python;
  // Classes, functions and pickles name the package that people import.
  const py::object name = module.attr("__name__");
  module.attr("__name__") = "tassilo";
  module.attr("__version__") = TASSILO_VERSION;
  py::register_exception<tassilo::Error>(module, "Error", PyExc_RuntimeError).doc() =
      "The outside world failed us: a file, a video, a configuration entry. Wrong arguments are ValueError or "
      "TypeError.";
  bind_region(module);
  bind_features(module);
  bind_image(module);
  bind_contour(module);
  bind_color(module);
  bind_camera(module);
  bind_vision(module);
  module.attr("__name__") = name;
}
