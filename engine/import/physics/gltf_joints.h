#pragma once

#include "engine/import/physics/physics_import.h"

#include <string>

namespace touchstone {

/// Reads the joints of nodes, with what TOUCHSTONE_joint adds. Expects the file's bodies.
class JointReader {
  public:
    explicit JointReader(PhysicsImport& import) : import_(import) {}

    /// Adds the joint of node `n`, if it states one, to the import's. Throws what PhysicsImport::context
    /// fails with.
    void read(size_t n);

  private:
    using json = nlohmann::json;
    void readLimit(const json& limit, const std::string& place, Joint& joint);
    void readDrive(const json& drive, const std::string& place, Joint& joint);
    void readSetting(const json& ours, const std::string& place, JointSetting& setting);
    void readOurs(const json& described, const std::string& place, Joint& joint);

    PhysicsImport& import_;
};

} // namespace touchstone
