#include "base/errors.h"
#include "bindings/bind.h"

#include <stdexcept>

namespace anistar::bindings {

void bind_errors(nb::module_ &module) {
  static nb::handle error_type =
      PyErr_NewException("anistar._core.MeshingError", PyExc_RuntimeError, nullptr);
  module.attr("MeshingError") = error_type;
  nb::register_exception_translator([](const std::exception_ptr &thrown, void *) {
    nb::list arguments;
    try {
      std::rethrow_exception(thrown);
    } catch (const MeshingError &error) {
      arguments.append(error.what());
      for (const double coordinate : error.place())
        arguments.append(coordinate);
    } catch (const std::domain_error &error) { // of what was checked: a failure of ours
      arguments.append(error.what());
    }
    PyErr_SetObject(error_type.ptr(), nb::tuple(arguments).ptr());
  });
}

} // namespace anistar::bindings
