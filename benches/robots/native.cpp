// Pinocchio's articulated-body algorithm, compiled against its headers: what a C++ program would run.
#include "model.hpp"

#include <pinocchio/algorithm/aba.hpp>

namespace {
struct Robot {
    pinocchio::Model model;
    pinocchio::Data data;
    explicit Robot(const char *file) : model(read(file)), data(model) {}
};
} // namespace

extern "C" void *native_make(const char *file) { return new Robot(file); }

extern "C" void native_run(void *self, const double *q, const double *v, const double *tau, double *out) {
    using In = Eigen::Map<const Eigen::VectorXd>;
    Robot &robot = *static_cast<Robot *>(self);
    const auto &model = robot.model;
    Eigen::Map<Eigen::VectorXd>(out, model.nv) =
        pinocchio::aba(model, robot.data, In(q, model.nq), In(v, model.nv), In(tau, model.nv));
}
