// slosh._core: what the Python package slosh is made of.
#include <pybind11/pybind11.h>

#include "peer/python/bindings.h"
#include "peer/python/words.h"
#include "sim/backend.h"

namespace py = pybind11;

namespace slosh::python {
namespace {

PyObject* error_type = nullptr;  // the module's, for as long as the interpreter lives

/// A RuntimeError with where, what and mend as attributes.
void raise(const Raised& raised) {
  py::object type = py::reinterpret_borrow<py::object>(error_type);
  py::object error = type(raised.text);
  error.attr("where") = raised.error.where;
  error.attr("what") = raised.error.what;
  error.attr("mend") = raised.error.mend;
  PyErr_SetObject(error_type, error.ptr());
}

}  // namespace
}  // namespace slosh::python

PYBIND11_MODULE(_core, m) {
  using namespace slosh;
  using namespace slosh::python;
  m.attr("__module__") = "slosh";  // what help() and messages call what is in it
  m.doc() = "Compiled part of the package slosh; import slosh.";
  error_type = PyErr_NewExceptionWithDoc(
      "slosh.Error",
      "Something that slosh refuses or cannot do. str() says where, what and how to mend it;\n"
      "the attributes where, what and mend hold the three apart.",
      PyExc_RuntimeError, nullptr);
  m.add_object("Error", py::reinterpret_borrow<py::object>(error_type));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Raised& raised) {
      raise(raised);
    }
  });
  m.attr("__version__") = SLOSH_VERSION;
  m.def(
      "backends",
      [] {
        std::string reason;
        py::dict out;
        out["cpu"] = true;
        out["cuda"] = cuda_available(&reason);
        if (!reason.empty()) out["why_no_cuda"] = reason;
        return out;
      },
      "Which backends work on this machine: {'cpu': True, 'cuda': bool} and, where CUDA does not, "
      "'why_no_cuda'.");
  bind_values(m);
  bind_scene(m);
  bind_builder(m);
  bind_world(m);
  bind_recording(m);
  bind_remote(m);
  py::delattr(m, "__module__");
}
