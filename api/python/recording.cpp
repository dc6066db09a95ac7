#include "api/python/arrays.h"
#include "api/python/bindings.h"

#include <string>

namespace touchstone::python {

namespace {

class Recording {
  public:
    explicit Recording(const std::string& file) {
        const py::gil_scoped_release released;
        ts::check(ts_recording_open(file.c_str(), handle_.out()));
    }
    [[nodiscard]] size_t hands() const {
        size_t count = 0;
        const py::gil_scoped_release released;
        ts::check(ts_recording_hands(handle_.get(), &count));
        return count;
    }
    py::dict read(size_t most, size_t hand) {
        const Ticks ticks(most, true);
        size_t count = 0;
        {
            const py::gil_scoped_release released;
            ts::check(ts_recording_read_hand(handle_.get(), hand, ticks.get(), &count));
        }
        return ticks.dict(count);
    }
    [[nodiscard]] std::string text(const std::string& what) const {
        return ts::text([&](char* out, size_t room, size_t* needed) {
            return ts_recording_text(handle_.get(), what.c_str(), out, room, needed);
        });
    }
    void close() { handle_.close(); }

  private:
    ts::Handle<ts_recording, ts_recording_close> handle_;
};

} // namespace

void bindRecording(py::module_& m) {
    py::class_<Recording>(m, "Recording")
        .def(py::init<const std::string&>())
        .def("hands", &Recording::hands)
        .def("read", &Recording::read)
        .def("text", &Recording::text)
        .def("close", &Recording::close);
}

} // namespace touchstone::python
