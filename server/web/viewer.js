// The page of `touchstone serve`: model, proxy, force, a chart and the settings, over the protocol of docs/server.md.
'use strict';
const token = location.hash.slice(1);
const $ = id => document.getElementById(id);
let socket, me = 0, asked = 0, state = null, model = null, objects = [], forceOn = true;
const waiting = new Map(), history_ = [];

function ask(verb, members = {}) {
    return new Promise((resolve, reject) => {
        const id = ++asked;
        waiting.set(id, {resolve, reject});
        socket.send(JSON.stringify({id, do: verb, ...members}));
    });
}

function connect() {
    socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/`);
    socket.onopen = async () => {
        try {
            const hello = await ask('authenticate', {token});
            me = hello.client;
            $('status').textContent = `connected, client ${me}`;
            showSettings((await ask('settings')).settings);
            if (hello.scene) showScene(hello.scene);
        } catch (error) { $('status').textContent = error.message; }
    };
    socket.onmessage = event => take(JSON.parse(event.data));
    socket.onclose = () => { $('status').textContent = 'connection closed'; };
}

/// Its slider is being dragged here: what comes back is older than the hand.
const editing = id => document.activeElement === $(`slide-${id}`) && $(`slide-${id}`).matches(':active');

function take(message) {
    if (message.id !== undefined && waiting.has(message.id)) {
        const {resolve, reject} = waiting.get(message.id);
        waiting.delete(message.id);
        if (message.ok) resolve(message); else reject(new Error(message.error));
    } else if (message.event === 'state') {
        state = message;
        forceOn = message.force_on;
        history_.push(message.force);
        if (history_.length > 320) history_.shift();
    } else if (message.event === 'scene') showScene(message.file);
    else if (message.event === 'setting') { if (!editing(`set-${message.name}`)) shown.settings[message.name]?.(message.value); }
    else if (message.event === 'material') {
        if (materials[message.material]) materials[message.material].values[message.name] = message.value;
        if (message.material === $('material').selectedIndex && !editing(`mat-${message.name}`)) shown.materials[message.name]?.(message.value);
    }
    else if (message.event === 'error') $('status').textContent = message.error;
}

// ---- Settings and materials: a slider and a field for each number, for who drives
const say = text => { $('status').textContent = text; };
/// Slider of 0..1000 to a value and back. Where the least is above 0 by decades: by the logarithm; else by the cube, finer near the least.
function scaleOf(low, high, logarithmic) {
    if (logarithmic && low > 0)
        return {at: t => low * Math.pow(high / low, t / 1000), of: v => 1000 * Math.log(v / low) / Math.log(high / low)};
    const wide = high - low > 100;
    return {at: t => low + (high - low) * Math.pow(t / 1000, wide ? 3 : 1), of: v => 1000 * Math.pow((v - low) / (high - low), wide ? 1 / 3 : 1)};
}
/// A row; `send` gets a number as it is dragged or typed. Returns its way to show a value.
function numberRow(parent, {id, label, unit, title, least, most, low, high, logarithmic}, send) {
    const row = document.createElement('label'), slider = document.createElement('input'), field = document.createElement('input');
    const scale = scaleOf(low, high, logarithmic);
    row.title = title;
    Object.assign(slider, {id: `slide-${id}`, type: 'range', min: 0, max: 1000, step: 'any'});
    Object.assign(field, {id, type: 'number', min: least, max: most, step: 'any'});
    const show = value => { field.value = value === null ? '' : Number(Number(value).toPrecision(6)); slider.value = value === null ? 0 : Math.min(1000, Math.max(0, scale.of(Number(value)))); };
    slider.oninput = () => { const value = Number(scale.at(Number(slider.value)).toPrecision(4)); field.value = value; send(value); };
    field.onchange = () => { slider.value = scale.of(Number(field.value)); send(field.value === '' ? null : Number(field.value)); };
    row.append(label, slider, field, unit);
    parent.append(row);
    return show;
}
/// Sends the newest value once the answer to the one before is here: a drag is no flood.
function sender(send) {
    let busy = false, next;
    const go = async value => {
        if (busy) { next = [value]; return; }
        busy = true;
        try { await drive(); await send(value); } catch (error) { say(error.message); }
        busy = false;
        if (next) { const [value] = next; next = undefined; go(value); }
    };
    return go;
}
const shown = {settings: {}, materials: {}};
function showSettings(all) {
    for (const setting of all) {
        const range = setting.allowed.match(/^(\S+) \.\. (\S+)/), title = `${setting.meaning} [${setting.allowed}]`;
        const send = sender(value => ask('set', {name: setting.name, value: String(value)}).then(() => say(`${setting.name} = ${value}`)));
        if (range) {
            const least = Number(range[1]), most = Number(range[2]);
            shown.settings[setting.name] = numberRow($('settings'), {id: `set-${setting.name}`, label: setting.name, unit: setting.unit, title, least, most, low: least, high: most}, send);
        } else {
            const label = document.createElement('label'), field = document.createElement('select');
            label.title = title;
            field.id = `set-${setting.name}`;
            for (const word of setting.allowed.split(', ')) field.append(new Option(word));
            field.onchange = () => send(field.value);
            label.append(setting.name, field, setting.unit);
            $('settings').append(label);
            shown.settings[setting.name] = value => { field.value = value; };
        }
        shown.settings[setting.name](setting.value);
    }
}
let materials = [];
async function showMaterials() {
    const {numbers, materials: all} = await ask('materials');
    materials = all;
    const choice = $('material');
    const before = choice.selectedIndex;
    choice.replaceChildren(...all.map((material, i) => new Option(material.name || `material ${i}`)));
    choice.selectedIndex = before >= 0 && before < all.length ? before : 0;
    $('numbers').replaceChildren();
    shown.materials = {};
    for (const number of numbers) {
        const send = sender(([material, value]) => ask('material', {material, name: number.name, value}).then(() => say(`${number.label} = ${value ?? 'as in the file'}`)));
        shown.materials[number.name] = numberRow($('numbers'), {...number, id: `mat-${number.name}`, title: `${number.meaning} [${number.least} .. ${number.most}; empty: as in the file]`},
            value => send([choice.selectedIndex, value]));
    }
    showMaterial();
}
function showMaterial() {
    const values = materials[$('material').selectedIndex]?.values ?? {};
    for (const [name, show] of Object.entries(shown.materials)) show(values[name] ?? null);
}
$('material').onchange = showMaterial;
const drive = () => state && state.driver === me ? Promise.resolve() : ask('drive');
$('drive').onclick = () => (state && state.driver === me ? ask('release') : ask('drive')).catch(error => { $('status').textContent = error.message; });
$('force').onclick = () => (forceOn ? ask('force', {on: false}) : drive().then(() => ask('force', {on: true})))
    .catch(error => { $('status').textContent = error.message; });

// ---- Model: corners of its triangles in the workspace
async function showScene(file) {
    $('scene').textContent = file ? file.split('/').pop() : 'a scene in memory';
    model = null;
    const answer = await fetch(`/scene?token=${token}`);
    if (!answer.ok) return;
    const positions = new Float32Array(await answer.arrayBuffer()), normals = new Float32Array(positions.length);
    for (let t = 0; t < positions.length; t += 9) {
        const [a, b, c] = [0, 3, 6].map(k => [...positions.subarray(t + k, t + k + 3)]);
        const n = normalize(cross(minus(b, a), minus(c, a)));
        for (let k = 0; k < 9; ++k) normals[t + k] = n[k % 3];
    }
    objects = (await ask('objects')).objects;
    model = upload(positions, normals);
    $('scene').textContent += `, ${model.count / 3} triangles`;
    await showMaterials();
}

// ---- Vectors; matrices are columns of four
const minus = (a, b) => a.map((x, i) => x - b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const normalize = a => { const l = Math.hypot(...a) || 1; return a.map(x => x / l); };
const multiply = (a, b) => { const m = []; for (let c = 0; c < 4; ++c) for (let r = 0; r < 4; ++r) { let s = 0; for (let k = 0; k < 4; ++k) s += a[4 * k + r] * b[4 * c + k]; m.push(s); } return m; };

// ---- Drawing
const canvas = $('view'), gl = canvas.getContext('webgl', {preserveDrawingBuffer: true});
let program, ball, camera = {yaw: 0.6, pitch: 0.45, distance: 0.4};
function upload(positions, normals) {
    const make = data => { const buffer = gl.createBuffer(); gl.bindBuffer(gl.ARRAY_BUFFER, buffer); gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW); return buffer; };
    return {positions: make(positions), normals: make(normals), count: positions.length / 3};
}
function prepare() {
    const shader = (type, source) => { const s = gl.createShader(type); gl.shaderSource(s, source); gl.compileShader(s); return s; };
    program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, `attribute vec3 p, n; uniform mat4 clipFromWorld; uniform vec3 offset, scale, rest; uniform vec4 turn; varying vec3 normal;
        vec3 turned(vec3 v) { return v + 2.0 * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v); }
        void main() { normal = turned(n); gl_Position = clipFromWorld * vec4(turned(p * scale - rest) + offset, 1.0); }`));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `precision mediump float; uniform vec3 color; varying vec3 normal;
        void main() { float l = 0.35 + 0.65 * abs(dot(normalize(normal), normalize(vec3(0.4, 0.8, 0.5)))); gl_FragColor = vec4(color * l, 1.0); }`));
    gl.linkProgram(program);
    const corners = [], rows = 12;
    const at = (i, k) => { const a = Math.PI * i / rows, b = Math.PI * k / rows; return [Math.sin(a) * Math.cos(b), Math.cos(a), Math.sin(a) * Math.sin(b)]; };
    for (let i = 0; i < rows; ++i) for (let k = 0; k < 2 * rows; ++k)
        corners.push(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k), at(i + 1, k + 1), at(i, k + 1));
    ball = upload(corners.flat(), corners.flat());
}
/// `turn` (x, y, z, w) about `rest`, which goes to `offset`.
function draw(shape, color, offset = [0, 0, 0], scale = [1, 1, 1], rest = [0, 0, 0], turn = [0, 0, 0, 1], first = 0, count = shape.count) {
    const set = (name, buffer) => { const a = gl.getAttribLocation(program, name); gl.bindBuffer(gl.ARRAY_BUFFER, buffer); gl.enableVertexAttribArray(a); gl.vertexAttribPointer(a, 3, gl.FLOAT, false, 0, 0); };
    set('p', shape.positions); set('n', shape.normals);
    gl.uniform3fv(gl.getUniformLocation(program, 'color'), color);
    gl.uniform3fv(gl.getUniformLocation(program, 'offset'), offset);
    gl.uniform3fv(gl.getUniformLocation(program, 'scale'), scale);
    gl.uniform3fv(gl.getUniformLocation(program, 'rest'), rest);
    gl.uniform4fv(gl.getUniformLocation(program, 'turn'), turn);
    gl.drawArrays(gl.TRIANGLES, first, count);
}
/// Each object where it is: those that clients have moved are in the states.
function drawModel() {
    const color = [0.55, 0.68, 0.75], moved = new Map((state?.moved ?? []).map(pose => [pose.object, pose]));
    if (!moved.size) { draw(model, color); return; }
    objects.forEach((object, i) => {
        const pose = moved.get(i), [w, x, y, z] = pose?.orientation ?? [1, 0, 0, 0];
        draw(model, color, pose?.position ?? object.centre, [1, 1, 1], object.centre, [x, y, z, w], 3 * object.first_triangle, 3 * object.triangles);
    });
}
function clipFromWorld() {
    const {yaw, pitch, distance} = camera, aspect = canvas.width / canvas.height, f = 1 / Math.tan(0.3), near = 0.01, far = 5;
    const back = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)], right = normalize(cross([0, 1, 0], back)), up = cross(back, right);
    const viewing = [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, 0, 0, -distance, 1];
    return multiply([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0], viewing);
}
function frame() {
    requestAnimationFrame(frame);
    canvas.width = canvas.clientWidth; canvas.height = canvas.clientHeight;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0.09, 0.13, 0.16, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(program);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, 'clipFromWorld'), false, clipFromWorld());
    if (model) drawModel();
    if (!state) return;
    draw(ball, [1, 1, 1], state.proxy, [0.003, 0.003, 0.003]);
    draw(ball, [1, 0.42, 0.37], state.hip, [0.002, 0.002, 0.002]);
    for (let i = 1; i <= 12; ++i) // the force: a row of beads, 2 cm a newton
        if (Math.hypot(...state.force) > 0.01) draw(ball, [1, 0.7, 0.28], state.proxy.map((x, k) => x + 0.02 * state.force[k] * i / 12), [0.001, 0.001, 0.001]);
    $('driver').textContent = state.driver === null ? 'nobody drives' : state.driver === me ? 'you drive' : `client ${state.driver} drives`;
    $('drive').textContent = state.driver === me ? 'Release' : 'Drive';
    $('force').textContent = forceOn ? 'Force off' : 'Force on';
    $('newtons').textContent = Math.hypot(...state.force).toFixed(3) + ' N';
    $('servo').textContent = `${state.ticks} ticks, ${state.missed} missed; ${state.contacts} contacts, ${(1e3 * state.penetration).toFixed(2)} mm deep`;
    chart();
}
function chart() {
    const pen = $('chart').getContext('2d'), {width, height} = $('chart'), most = Math.max(0.5, ...history_.flat().map(Math.abs));
    pen.clearRect(0, 0, width, height);
    ['#ff6b5e', '#7fd17f', '#6fb1ff'].forEach((color, axis) => {
        pen.strokeStyle = color; pen.beginPath();
        history_.forEach((force, i) => pen.lineTo(i, height / 2 * (1 - 0.95 * force[axis] / most)));
        pen.stroke();
    });
}
canvas.onpointermove = event => { if (event.buttons) { camera.yaw -= event.movementX * 0.01; camera.pitch = Math.min(1.5, Math.max(-1.5, camera.pitch + event.movementY * 0.01)); } };
canvas.onwheel = event => { camera.distance = Math.min(2, Math.max(0.1, camera.distance * Math.exp(event.deltaY * 0.001))); event.preventDefault(); };
prepare();
frame();
connect();
