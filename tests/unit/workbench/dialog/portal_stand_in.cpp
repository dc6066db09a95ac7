// portal_stand_in ANSWER FILE: the file chooser of xdg-desktop-portal on the session's bus, without a dialog.
// Writes each request to FILE, then answers it:
//   refuse          with an error, as a portal that has no file chooser
//   cancel, end     after half a second: the person cancels; the dialog ends in another way
//   vanish          after half a second it leaves the bus
//   wait            never
//   file:... ...    with these URIs

#include <dbus/dbus.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr const char* kName = "org.freedesktop.portal.Desktop";
constexpr const char* kHandle = "/org/freedesktop/portal/desktop/request/stand/in";

/// All strings, numbers and byte arrays in order, one a line.
void write(DBusMessageIter& at, std::ofstream& out) {
    for (int type = dbus_message_iter_get_arg_type(&at); type != DBUS_TYPE_INVALID;
         dbus_message_iter_next(&at), type = dbus_message_iter_get_arg_type(&at)) {
        if (type == DBUS_TYPE_STRING) {
            const char* text = nullptr;
            dbus_message_iter_get_basic(&at, &text);
            out << text << '\n';
        } else if (type == DBUS_TYPE_ARRAY && dbus_message_iter_get_element_type(&at) == DBUS_TYPE_BYTE) {
            DBusMessageIter bytes;
            dbus_message_iter_recurse(&at, &bytes);
            const char* data = nullptr;
            int count = 0;
            dbus_message_iter_get_fixed_array(&bytes, &data, &count);
            out << "bytes " << count << ' ' << data << '\n';
        } else if (type == DBUS_TYPE_ARRAY || type == DBUS_TYPE_VARIANT || type == DBUS_TYPE_STRUCT ||
                   type == DBUS_TYPE_DICT_ENTRY) {
            DBusMessageIter inside;
            dbus_message_iter_recurse(&at, &inside);
            write(inside, out);
        }
    }
}

void respond(DBusConnection* bus, unsigned code, const std::vector<std::string>& uris) {
    DBusMessage* signal = dbus_message_new_signal(kHandle, "org.freedesktop.portal.Request", "Response");
    DBusMessageIter arguments, results, entry, value, list;
    dbus_message_iter_init_append(signal, &arguments);
    const dbus_uint32_t number = code;
    dbus_message_iter_append_basic(&arguments, DBUS_TYPE_UINT32, &number);
    dbus_message_iter_open_container(&arguments, DBUS_TYPE_ARRAY, "{sv}", &results);
    dbus_message_iter_open_container(&results, DBUS_TYPE_DICT_ENTRY, nullptr, &entry);
    const char* key = "uris";
    dbus_message_iter_append_basic(&entry, DBUS_TYPE_STRING, &key);
    dbus_message_iter_open_container(&entry, DBUS_TYPE_VARIANT, "as", &value);
    dbus_message_iter_open_container(&value, DBUS_TYPE_ARRAY, "s", &list);
    for (const std::string& uri : uris) {
        const char* text = uri.c_str();
        dbus_message_iter_append_basic(&list, DBUS_TYPE_STRING, &text);
    }
    dbus_message_iter_close_container(&value, &list);
    dbus_message_iter_close_container(&entry, &value);
    dbus_message_iter_close_container(&results, &entry);
    dbus_message_iter_close_container(&arguments, &results);
    dbus_connection_send(bus, signal, nullptr);
    dbus_message_unref(signal);
}

void answer(DBusConnection* bus, DBusMessage* call, const std::string& how) {
    DBusMessage* reply = how == "refuse"
                             ? dbus_message_new_error(call, DBUS_ERROR_UNKNOWN_METHOD, "no file chooser")
                             : dbus_message_new_method_return(call);
    const char* handle = kHandle;
    if (how != "refuse")
        dbus_message_append_args(reply, DBUS_TYPE_OBJECT_PATH, &handle, DBUS_TYPE_INVALID);
    dbus_connection_send(bus, reply, nullptr);
    dbus_message_unref(reply);
    dbus_connection_flush(bus);
    constexpr unsigned kPerson = 500'000; // µs
    if (how == "cancel" || how == "end" || how == "vanish")
        usleep(kPerson);
    if (how == "vanish")
        dbus_bus_release_name(bus, kName, nullptr);
    else if (how == "cancel" || how == "end")
        respond(bus, how == "cancel" ? 1 : 2, {});
    else if (how.starts_with("file:") || how.starts_with("http:")) {
        std::istringstream words(how);
        std::vector<std::string> uris;
        for (std::string uri; words >> uri;)
            uris.push_back(uri);
        respond(bus, 0, uris);
    }
    dbus_connection_flush(bus);
}

} // namespace

int main(int count, char** arguments) {
    DBusConnection* bus = count == 3 ? dbus_bus_get(DBUS_BUS_SESSION, nullptr) : nullptr;
    if (bus == nullptr || dbus_bus_request_name(bus, kName, 0, nullptr) < 0)
        return 1;
    std::puts("ready");
    std::fflush(stdout);
    do {
        while (DBusMessage* message = dbus_connection_pop_message(bus)) {
            const char* member = dbus_message_get_member(message);
            const char* interface = dbus_message_get_interface(message);
            if (dbus_message_get_type(message) == DBUS_MESSAGE_TYPE_METHOD_CALL && interface != nullptr &&
                std::string_view(interface) == "org.freedesktop.portal.FileChooser") {
                std::ofstream out(arguments[2]);
                out << member << '\n';
                DBusMessageIter at;
                if (dbus_message_iter_init(message, &at) != 0)
                    write(at, out);
                out.close();
                answer(bus, message, arguments[1]);
            }
            dbus_message_unref(message);
        }
    } while (dbus_connection_read_write(bus, -1) != 0);
    return 0;
}
