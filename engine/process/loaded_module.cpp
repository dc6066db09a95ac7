#include "engine/process/loaded_module.h"

#include "engine/process/helper_program.h"

#include <dlfcn.h>

namespace touchstone {

void* functionOfModule(const std::string& name, const char* symbol, std::string& why) {
    void* const module = dlopen(helperProgram(name).c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    void* const function = module != nullptr ? dlsym(module, symbol) : nullptr;
    if (function == nullptr) {
        const char* const said = dlerror();
        why = said != nullptr ? said : "no reason";
    }
    return function;
}

} // namespace touchstone
