#include "transfer/symmetric_system.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"

namespace anistar::bindings {
namespace {

const char *name_of(SystemStop stop) {
  switch (stop) {
  case SystemStop::solved:
    return "solved";
  case SystemStop::least_squares:
    return "least_squares";
  case SystemStop::step_limit:
    return "step_limit";
  case SystemStop::not_finite:
    return "not_finite";
  }
  return "unknown";
}

/// One right-hand side after another, so that none depends on the others.
nb::tuple solve(const SymmetricSystem &system, const Array2<double> &rights,
                const Array2<double> &starts, double residual, std::size_t max_steps) {
  const std::size_t n = system.size(), count = rights.shape(0);
  if (rights.shape(1) != n || starts.shape(0) != count || starts.shape(1) != n)
    throw std::invalid_argument("rights and starts need " + std::to_string(n) +
                                " columns and as many rows");
  const SystemBounds bounds{residual, max_steps, &look_for_signals};
  std::vector<double> values;
  nb::list stops, residuals;
  for (std::size_t k = 0; k < count; ++k) {
    SystemSolution found;
    {
      nb::gil_scoped_release release;
      found =
          system.solved({rights.data() + k * n, n}, {starts.data() + k * n, n}, bounds);
      values.insert(values.end(), found.values.begin(), found.values.end());
    }
    stops.append(name_of(found.stop));
    residuals.append(found.residual);
  }
  return nb::make_tuple(owned(std::move(values), {count, n}), stops, residuals);
}

} // namespace

void bind_symmetric_system(nb::module_ &module) {
  nb::class_<SymmetricSystem>(module, "SymmetricSystem",
                              "A sparse symmetric positive semi-definite system.")
      .def(
          "__init__",
          [](SymmetricSystem *self, const Array1<std::int64_t> &starts,
             const Array1<Index> &columns, const Array1<double> &values) {
            new (self) SymmetricSystem({{starts.data(), starts.size()},
                                        {columns.data(), columns.size()},
                                        {values.data(), values.size()}});
          },
          nb::arg("starts").noconvert(), nb::arg("columns").noconvert(),
          nb::arg("values").noconvert())
      .def(
          "solve", &solve, nb::arg("rights").noconvert(), nb::arg("starts").noconvert(),
          nb::kw_only(), nb::arg("residual"), nb::arg("max_steps"),
          "Solve for the rows of `rights`, from those of `starts`; returns (solutions, "
          "stop reasons, residuals).");
}

} // namespace anistar::bindings
