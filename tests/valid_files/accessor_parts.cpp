#include "tests/valid_files/accessor_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone::test {
namespace {

using nlohmann::json;

constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

size_t bytesOf(int componentType) {
    return componentType == kByte || componentType == kUByte     ? 1
           : componentType == kShort || componentType == kUShort ? 2
                                                                 : 4;
}

double greatest(int componentType) {
    switch (componentType) {
    case kByte:
        return 127.0;
    case kUByte:
        return 255.0;
    case kShort:
        return 32767.0;
    case kUShort:
        return 65535.0;
    default:
        return 4294967295.0;
    }
}

/// The number as the file holds it, for min and max: these are of the stored values.
double stored(const Column& column, double value) {
    if (column.componentType == kFloat)
        return static_cast<double>(static_cast<float>(value));
    const double low = column.componentType == kByte    ? -127.0
                       : column.componentType == kShort ? -32767.0
                                                        : 0.0;
    const double high = greatest(column.componentType);
    return std::clamp(std::round(column.normalized ? value * high : value), low, high);
}

void put(std::vector<uint8_t>& bytes, const Column& column, double value) {
    uint32_t bits = 0;
    if (column.componentType == kFloat) {
        const auto single = static_cast<float>(value);
        std::memcpy(&bits, &single, sizeof bits);
    } else {
        bits = static_cast<uint32_t>(static_cast<int64_t>(stored(column, value)));
    }
    for (size_t i = 0; i < bytesOf(column.componentType); ++i)
        bytes.push_back(static_cast<uint8_t>(bits >> (8 * i)));
}

void putElement(std::vector<uint8_t>& bytes, const Column& column, size_t element) {
    for (size_t c = 0; c < column.components(); ++c)
        put(bytes, column, column.values[element * column.components() + c]);
}

/// Bytes of an element, up to the next multiple of `alignment`.
size_t sizeOf(const Column& column, size_t alignment) {
    const size_t size = column.components() * bytesOf(column.componentType);
    return (size + alignment - 1) / alignment * alignment;
}

json accessorOf(const Column& column) {
    json accessor = {
        {"componentType", column.componentType}, {"count", column.count()}, {"type", column.type}};
    if (column.normalized)
        accessor["normalized"] = true;
    if (!column.bounds)
        return accessor;
    const size_t n = column.components();
    std::vector<double> low(n, INFINITY), high(n, -INFINITY);
    for (size_t i = 0; i < column.values.size(); ++i) {
        low[i % n] = std::min(low[i % n], stored(column, column.values[i]));
        high[i % n] = std::max(high[i % n], stored(column, column.values[i]));
    }
    accessor["min"] = low;
    accessor["max"] = high;
    return accessor;
}

/// Moves some elements, or all that are not zero, to a sparse part. `base` becomes what the buffer view
/// holds; it is empty where there is none.
json sparseOf(FileDraft& draft, Column& base, bool withView) {
    const Column whole = base;
    const size_t n = whole.components();
    std::vector<uint32_t> replaced;
    for (size_t e = 0; e < whole.count(); ++e) {
        const bool zero =
            std::all_of(&whole.values[e * n], &whole.values[e * n] + n, [](double v) { return v == 0.0; });
        if (withView ? draft.draw.chance(0.2) : !zero)
            replaced.push_back(static_cast<uint32_t>(e));
    }
    if (replaced.empty())
        replaced.push_back(0);
    std::vector<uint8_t> values, indices;
    const int indexType = whole.count() <= 255 ? draft.draw.pick(std::vector{kUByte, kUShort, kUInt})
                                               : draft.draw.pick(std::vector{kUShort, kUInt});
    for (const uint32_t e : replaced) {
        putElement(values, whole, e);
        put(indices, {"SCALAR", indexType, false, {}, false}, e);
        for (size_t c = 0; c < n; ++c)
            base.values[e * n + c] = 0.0;
    }
    if (!withView)
        base.values.clear();
    const size_t valueView = draft.maker.addView(values.data(), values.size());
    return {
        {"count", replaced.size()},
        {"indices",
         {{"bufferView", draft.maker.addView(indices.data(), indices.size())}, {"componentType", indexType}}},
        {"values", {{"bufferView", valueView}}}};
}

/// One buffer view for all of `names`, element by element; strides are multiples of four, as vertex
/// attributes ask.
void writeInterleaved(FileDraft& draft, const std::map<std::string, Column>& columns,
                      std::vector<std::string> names, std::map<std::string, size_t>& accessors) {
    while (!names.empty()) {
        size_t stride = 0, taken = 0;
        std::vector<size_t> offsets;
        while (taken < names.size() && stride + sizeOf(columns.at(names[taken]), 4) <= 252) {
            offsets.push_back(stride);
            stride += sizeOf(columns.at(names[taken++]), 4);
        }
        std::vector<uint8_t> bytes;
        for (size_t e = 0; e < columns.at(names[0]).count(); ++e) {
            const size_t begin = bytes.size();
            for (size_t i = 0; i < taken; ++i) {
                bytes.resize(begin + offsets[i], 0xA5);
                putElement(bytes, columns.at(names[i]), e);
            }
            bytes.resize(begin + stride, 0xA5);
        }
        const size_t view = draft.maker.addView(bytes.data(), bytes.size(), stride);
        draft.maker.json["bufferViews"][view]["target"] = kArrayBuffer;
        for (size_t i = 0; i < taken; ++i) {
            json accessor = accessorOf(columns.at(names[i]));
            accessor["bufferView"] = view;
            if (offsets[i] != 0 || draft.draw.chance(0.5))
                accessor["byteOffset"] = offsets[i];
            accessors[names[i]] = draft.maker.append("accessors", std::move(accessor));
        }
        names.erase(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(taken));
    }
}

/// One after the other in one view: `names` have elements of one size.
void writeShared(FileDraft& draft, const std::map<std::string, Column>& columns,
                 const std::vector<std::string>& names, std::map<std::string, size_t>& accessors) {
    const size_t stride =
        sizeOf(columns.at(names[0]), 4) + (draft.has(Feature::Padded) ? 4 * draft.draw.below(6) : 0);
    std::vector<uint8_t> bytes;
    std::vector<size_t> offsets;
    for (const std::string& name : names) {
        offsets.push_back(bytes.size());
        for (size_t e = 0; e < columns.at(name).count(); ++e) {
            const size_t begin = bytes.size();
            putElement(bytes, columns.at(name), e);
            bytes.resize(begin + stride, 0x5A);
        }
    }
    const bool tight = names.size() == 1 && stride == sizeOf(columns.at(names[0]), 1);
    const size_t view =
        draft.maker.addView(bytes.data(), bytes.size(), tight && draft.draw.chance(0.5) ? 0 : stride);
    draft.maker.json["bufferViews"][view]["target"] = kArrayBuffer;
    for (size_t i = 0; i < names.size(); ++i) {
        json accessor = accessorOf(columns.at(names[i]));
        accessor["bufferView"] = view;
        accessor["byteOffset"] = offsets[i];
        accessors[names[i]] = draft.maker.append("accessors", std::move(accessor));
    }
}

} // namespace

void FileDraft::use(const std::string& extension, bool required) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!required && list == std::string("extensionsRequired"))
            continue;
        json& names = maker.json[list];
        if (names.is_null())
            names = json::array();
        if (std::find(names.begin(), names.end(), extension) == names.end())
            names.push_back(extension);
    }
}

size_t Column::components() const {
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type.back() - '0');
}

std::map<std::string, size_t> writeVertices(FileDraft& draft, const std::map<std::string, Column>& columns) {
    std::map<std::string, size_t> accessors;
    std::vector<std::string> left;
    std::map<size_t, std::vector<std::string>> bySize;
    for (const auto& [name, column] : columns) {
        // Sparse accessors are written one by one; the others in views of several.
        if ((draft.has(Feature::Sparse) || draft.has(Feature::SparseOnly)) && draft.draw.chance(0.5)) {
            const bool withView =
                !draft.has(Feature::SparseOnly) || (draft.has(Feature::Sparse) && draft.draw.chance(0.5));
            Column base = column;
            json accessor = accessorOf(column);
            accessor["sparse"] = sparseOf(draft, base, withView);
            if (withView) {
                base.bounds = false;
                std::map<std::string, size_t> one;
                writeShared(draft, {{name, base}}, {name}, one);
                accessor["bufferView"] = draft.maker.json["accessors"][one[name]]["bufferView"];
                draft.maker.json["accessors"].erase(one[name]);
            }
            accessors[name] = draft.maker.append("accessors", std::move(accessor));
        } else {
            left.push_back(name);
            bySize[sizeOf(column, 4)].push_back(name);
        }
    }
    if (draft.has(Feature::Interleaved)) {
        writeInterleaved(draft, columns, left, accessors);
        return accessors;
    }
    for (const auto& [size, names] : bySize)
        if (draft.has(Feature::SharedView))
            writeShared(draft, columns, names, accessors);
        else
            for (const std::string& name : names)
                writeShared(draft, columns, {name}, accessors);
    return accessors;
}

size_t writeColumn(FileDraft& draft, const Column& column) {
    Column base = column;
    json accessor = accessorOf(column);
    if (draft.has(Feature::Sparse) && draft.draw.chance(0.3))
        accessor["sparse"] = sparseOf(draft, base, true);
    std::vector<uint8_t> bytes;
    for (size_t e = 0; e < base.count(); ++e)
        putElement(bytes, base, e);
    accessor["bufferView"] = draft.maker.addView(bytes.data(), bytes.size());
    return draft.maker.append("accessors", std::move(accessor));
}

size_t writeIndices(FileDraft& draft, const std::vector<uint32_t>& indices) {
    const uint32_t last = *std::max_element(indices.begin(), indices.end());
    std::vector<int> types{kUInt};
    if (last < 65535)
        types.push_back(kUShort);
    if (last < 255)
        types.push_back(kUByte);
    Column column{"SCALAR",
                  draft.has(Feature::NarrowIndices) ? types.back() : draft.draw.pick(types),
                  false,
                  {},
                  false};
    column.values.assign(indices.begin(), indices.end());
    column.bounds = draft.draw.chance(0.3);
    const size_t accessor = writeColumn(draft, column);
    draft.maker
        .json["bufferViews"][draft.maker.json["accessors"][accessor]["bufferView"].get<size_t>()]["target"] =
        kElementArrayBuffer;
    return accessor;
}

} // namespace touchstone::test
