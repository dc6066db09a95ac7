#include "workbench/dialog/portal/file_chooser.h"

#include "workbench/dialog/portal/file_uri.h"

#include <dbus/dbus.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <string_view>

namespace touchstone {

namespace {

constexpr const char* kPortal = "org.freedesktop.portal.Desktop";
constexpr const char* kObject = "/org/freedesktop/portal/desktop";
constexpr const char* kChooser = "org.freedesktop.portal.FileChooser";
constexpr const char* kRequest = "org.freedesktop.portal.Request";
constexpr int kStart = 10'000; // ms: the bus may have to start the portal first

struct CloseConnection {
    void operator()(DBusConnection* bus) const {
        dbus_connection_close(bus);
        dbus_connection_unref(bus);
    }
};
struct DropMessage {
    void operator()(DBusMessage* message) const { dbus_message_unref(message); }
};
using Connection = std::unique_ptr<DBusConnection, CloseConnection>;
using Message = std::unique_ptr<DBusMessage, DropMessage>;

/// A container of the message, closed at the end of its life.
class Container {
  public:
    Container(DBusMessageIter& parent, int type, const char* signature) : parent_(parent) {
        dbus_message_iter_open_container(&parent_, type, signature, &iterator_);
    }
    ~Container() { dbus_message_iter_close_container(&parent_, &iterator_); }
    Container(const Container&) = delete;
    Container& operator=(const Container&) = delete;
    [[nodiscard]] DBusMessageIter& in() { return iterator_; }

    /// D-Bus knows strings in UTF-8 alone, and ends whoever appends another.
    void text(const std::string& value) {
        const char* bytes = dbus_validate_utf8(value.c_str(), nullptr) != 0 ? value.c_str() : "";
        dbus_message_iter_append_basic(&iterator_, DBUS_TYPE_STRING, &bytes);
    }
    void number(dbus_uint32_t value) { dbus_message_iter_append_basic(&iterator_, DBUS_TYPE_UINT32, &value); }

  private:
    DBusMessageIter& parent_;
    DBusMessageIter iterator_{};
};

/// An entry NAME: VALUE of an a{sv}; `append` writes the value of this signature.
template <class Append>
void option(Container& options, const char* name, const char* signature, const Append& append) {
    Container entry(options.in(), DBUS_TYPE_DICT_ENTRY, nullptr);
    entry.text(name);
    Container value(entry.in(), DBUS_TYPE_VARIANT, signature);
    append(value);
}

void textOption(Container& options, const char* name, const std::string& text) {
    option(options, name, "s", [&](Container& value) { value.text(text); });
}

/// A path, which is bytes with a NUL at their end.
void pathOption(Container& options, const char* name, const std::string& path) {
    option(options, name, "ay", [&](Container& value) {
        Container array(value.in(), DBUS_TYPE_ARRAY, "y");
        const char* bytes = path.c_str();
        dbus_message_iter_append_fixed_array(&array.in(), DBUS_TYPE_BYTE, &bytes,
                                             static_cast<int>(path.size() + 1));
    });
}

void filterOption(Container& options, const std::vector<ChooserFilter>& filters) {
    option(options, "filters", "a(sa(us))", [&](Container& value) {
        Container list(value.in(), DBUS_TYPE_ARRAY, "(sa(us))");
        for (const ChooserFilter& each : filters) {
            Container filter(list.in(), DBUS_TYPE_STRUCT, nullptr);
            filter.text(each.name);
            Container patterns(filter.in(), DBUS_TYPE_ARRAY, "(us)");
            for (const std::string& pattern : each.patterns) {
                Container one(patterns.in(), DBUS_TYPE_STRUCT, nullptr);
                one.number(0); // a pattern of names; 1 would be a MIME type
                one.text(pattern);
            }
        }
    });
}

Message callOf(const ChooserRequest& request, const std::string& token) {
    Message call(
        dbus_message_new_method_call(kPortal, kObject, kChooser, request.saves ? "SaveFile" : "OpenFile"));
    if (call == nullptr)
        return call;
    DBusMessageIter arguments;
    dbus_message_iter_init_append(call.get(), &arguments);
    const char* parent = ""; // no window in particular
    const char* title = request.title.c_str();
    dbus_message_iter_append_basic(&arguments, DBUS_TYPE_STRING, &parent);
    dbus_message_iter_append_basic(&arguments, DBUS_TYPE_STRING, &title);
    Container options(arguments, DBUS_TYPE_ARRAY, "{sv}");
    textOption(options, "handle_token", token);
    if (!request.folder.empty())
        pathOption(options, "current_folder", request.folder);
    if (request.saves && !request.name.empty())
        textOption(options, "current_name", request.name);
    if (!request.filters.empty())
        filterOption(options, request.filters);
    return call;
}

/// The one URI of the results, an a{sv}; nothing where there are more or none.
std::optional<std::string> onlyUri(DBusMessageIter results) {
    std::optional<std::string> found;
    if (dbus_message_iter_get_arg_type(&results) != DBUS_TYPE_ARRAY ||
        dbus_message_iter_get_element_type(&results) != DBUS_TYPE_DICT_ENTRY)
        return found;
    DBusMessageIter entry, pair, value, uri;
    for (dbus_message_iter_recurse(&results, &entry);
         dbus_message_iter_get_arg_type(&entry) == DBUS_TYPE_DICT_ENTRY; dbus_message_iter_next(&entry)) {
        dbus_message_iter_recurse(&entry, &pair);
        const char* key = nullptr;
        if (dbus_message_iter_get_arg_type(&pair) != DBUS_TYPE_STRING)
            continue;
        dbus_message_iter_get_basic(&pair, &key);
        if (std::string_view(key) != "uris" || dbus_message_iter_next(&pair) == 0 ||
            dbus_message_iter_get_arg_type(&pair) != DBUS_TYPE_VARIANT)
            continue;
        dbus_message_iter_recurse(&pair, &value);
        if (dbus_message_iter_get_arg_type(&value) != DBUS_TYPE_ARRAY)
            continue;
        for (dbus_message_iter_recurse(&value, &uri);
             dbus_message_iter_get_arg_type(&uri) == DBUS_TYPE_STRING; dbus_message_iter_next(&uri)) {
            if (found)
                return std::nullopt;
            const char* text = nullptr;
            dbus_message_iter_get_basic(&uri, &text);
            found = text;
        }
    }
    return found;
}

ChooserAnswer answerIn(DBusMessage* response) {
    using enum ChooserAnswer::End;
    DBusMessageIter arguments;
    if (dbus_message_iter_init(response, &arguments) == 0 ||
        dbus_message_iter_get_arg_type(&arguments) != DBUS_TYPE_UINT32)
        return {Failed, {}};
    dbus_uint32_t code = 2; // 0: chosen, 1: cancelled, 2: ended in another way
    dbus_message_iter_get_basic(&arguments, &code);
    if (code == 1)
        return {Cancelled, {}};
    if (code != 0 || dbus_message_iter_next(&arguments) == 0)
        return {Failed, {}};
    const std::optional<std::string> uri = onlyUri(arguments);
    const std::optional<std::string> path = uri ? pathOfUri(*uri) : std::nullopt;
    return path ? ChooserAnswer{Chosen, *path} : ChooserAnswer{Failed, {}};
}

/// Whether the signal says that the portal has left the bus.
bool saysPortalIsGone(DBusMessage* message) {
    const char *name = nullptr, *before = nullptr, *after = nullptr;
    return dbus_message_is_signal(message, DBUS_INTERFACE_DBUS, "NameOwnerChanged") != 0 &&
           dbus_message_get_args(message, nullptr, DBUS_TYPE_STRING, &name, DBUS_TYPE_STRING, &before,
                                 DBUS_TYPE_STRING, &after, DBUS_TYPE_INVALID) != 0 &&
           std::string_view(name) == kPortal && *before != '\0' && *after == '\0';
}

} // namespace

ChooserAnswer askPortal(const ChooserRequest& request) {
    using enum ChooserAnswer::End;
    const Connection bus(dbus_bus_get_private(DBUS_BUS_SESSION, nullptr));
    if (bus == nullptr)
        return {Absent, {}};
    dbus_connection_set_exit_on_disconnect(bus.get(), 0);
    const std::string token = "touchstone_" + std::to_string(getpid());
    // Before the call, or a quick answer is missed. What others send is not let in: the bus knows the sender.
    const std::string from =
        std::string("type='signal',sender='") + kPortal + "',interface='" + kRequest + "',member='Response'";
    dbus_bus_add_match(bus.get(), from.c_str(), nullptr);
    const std::string owner = std::string("type='signal',sender='") + DBUS_SERVICE_DBUS +
                              "',member='NameOwnerChanged',arg0='" + kPortal + "'";
    dbus_bus_add_match(bus.get(), owner.c_str(), nullptr);

    const Message call = callOf(request, token);
    const Message reply(
        call != nullptr ? dbus_connection_send_with_reply_and_block(bus.get(), call.get(), kStart, nullptr)
                        : nullptr);
    const char* handle = nullptr;
    if (reply == nullptr ||
        dbus_message_get_args(reply.get(), nullptr, DBUS_TYPE_OBJECT_PATH, &handle, DBUS_TYPE_INVALID) == 0)
        return {Absent, {}};
    const std::string object = handle;
    do { // what came before the reply is in the queue already
        while (Message message{dbus_connection_pop_message(bus.get())}) {
            if (dbus_message_is_signal(message.get(), kRequest, "Response") != 0 &&
                dbus_message_has_path(message.get(), object.c_str()) != 0)
                return answerIn(message.get());
            if (saysPortalIsGone(message.get()))
                return {Failed, {}};
        }
    } while (dbus_connection_read_write(bus.get(), -1) != 0);
    return {Failed, {}}; // the bus has gone
}

} // namespace touchstone
