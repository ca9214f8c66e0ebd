// Pinocchio's articulated-body algorithm unrolled by CasADi: reads a list of joints, writes C, prints its operations.
#include <pinocchio/autodiff/casadi.hpp>

#include "model.hpp"

#include <pinocchio/algorithm/aba.hpp>

#include <iostream>

int main(int, char **argv) {
    using casadi::SX;
    using Scalar = SX;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
    const auto model = read(argv[1]).cast<Scalar>();
    pinocchio::DataTpl<Scalar> data(model);
    const SX q = SX::sym("q", model.nq), v = SX::sym("v", model.nv), tau = SX::sym("tau", model.nv);
    Vector eq(model.nq), ev(model.nv), etau(model.nv);
    pinocchio::casadi::copy(q, eq);
    pinocchio::casadi::copy(v, ev);
    pinocchio::casadi::copy(tau, etau);
    pinocchio::aba(model, data, eq, ev, etau);
    SX out(model.nv, 1);
    pinocchio::casadi::copy(data.ddq, out);
    out = cse(out);
    const casadi::Function f("pinocchio_aba", std::vector<SX>{q, v, tau}, std::vector<SX>{out});
    casadi_int operations = 0;
    for (casadi_int k = 0; k < f.n_instructions(); k++) {
        switch (f.instruction_id(k)) {
        case casadi::OP_ADD:
        case casadi::OP_SUB:
        case casadi::OP_MUL:
        case casadi::OP_DIV:
        case casadi::OP_SQ:
        case casadi::OP_TWICE:
        case casadi::OP_INV: operations++; break;
        default: break;
        }
    }
    f.generate(argv[2]);
    std::cout << operations << std::endl;
}
