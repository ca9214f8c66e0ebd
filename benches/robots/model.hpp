// A tree of joints from the list that run.py writes, a line a joint:
//   parent kind axis(3) rotation(9, row by row) translation(3) mass centre(3) inertia(xx xy yy xz yz zz)
// with kind one of revolute, prismatic, floating. Parents come before children; 0 is the world.
// The list stands for the URDF file: a parser from a library that was built for another processor would lay out Eigen's
// vectors in another way.
#pragma once

#include <pinocchio/multibody.hpp>

#include <fstream>
#include <stdexcept>
#include <string>

inline pinocchio::JointModel joint(const std::string &kind, const Eigen::Vector3d &axis) {
    using namespace pinocchio;
    int along = 0;
    while (along < 3 && axis != Eigen::Vector3d::Unit(along)) along++;
    if (kind == "floating") return JointModelFreeFlyer();
    if (kind == "revolute") {
        switch (along) {
        case 0: return JointModelRX();
        case 1: return JointModelRY();
        case 2: return JointModelRZ();
        default: return JointModelRevoluteUnaligned(axis);
        }
    }
    if (kind != "prismatic") throw std::runtime_error("unknown kind of joint: " + kind);
    switch (along) {
    case 0: return JointModelPX();
    case 1: return JointModelPY();
    case 2: return JointModelPZ();
    default: return JointModelPrismaticUnaligned(axis);
    }
}

inline pinocchio::Model read(const char *file) {
    pinocchio::Model model;
    std::ifstream in(file);
    std::size_t parent;
    std::string kind;
    while (in >> parent >> kind) {
        Eigen::Vector3d axis, translation, centre;
        Eigen::Matrix3d rotation, inertia;
        double mass, xx, xy, yy, xz, yz, zz;
        for (int k = 0; k < 3; k++) in >> axis[k];
        for (int k = 0; k < 9; k++) in >> rotation(k / 3, k % 3);
        for (int k = 0; k < 3; k++) in >> translation[k];
        in >> mass;
        for (int k = 0; k < 3; k++) in >> centre[k];
        in >> xx >> xy >> yy >> xz >> yz >> zz;
        if (!in) throw std::runtime_error(std::string("not a list of joints: ") + file);
        inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        const pinocchio::SE3 place(rotation, translation);
        const auto index = model.addJoint(parent, joint(kind, axis), place, "j" + std::to_string(model.njoints));
        model.appendBodyToJoint(index, pinocchio::Inertia(mass, centre, inertia), pinocchio::SE3::Identity());
    }
    return model;
}
