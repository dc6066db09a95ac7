// The page of `touchstone serve`: model, proxy, force, a chart and the settings, over the protocol of docs/server.md.
'use strict';
const token = location.hash.slice(1);
const $ = id => document.getElementById(id);
let socket, me = 0, asked = 0, state = null, model = null, forceOn = true;
const waiting = new Map(), history_ = [];

function ask(verb, members = {}) {
    return new Promise((resolve, reject) => {
        const id = ++asked;
        waiting.set(id, {resolve, reject});
        socket.send(JSON.stringify({id, do: verb, ...members}));
    });
}

function connect() {
    socket = new WebSocket(`ws://${location.host}/`);
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
    else if (message.event === 'setting') { const field = $(`set-${message.name}`); if (field) field.value = message.value; }
    else if (message.event === 'error') $('status').textContent = message.error;
}

// ---- Settings
function showSettings(all) {
    for (const setting of all) {
        const label = document.createElement('label');
        label.title = `${setting.meaning} [${setting.allowed}]`;
        label.append(setting.name);
        const range = setting.allowed.match(/^(\S+) \.\. (\S+)/);
        const field = document.createElement(range ? 'input' : 'select');
        field.id = `set-${setting.name}`;
        if (range) { field.type = 'number'; field.min = range[1]; field.max = range[2]; field.step = 'any'; }
        else for (const word of setting.allowed.split(', ')) field.append(new Option(word));
        field.value = setting.initial;
        field.onchange = () => drive().then(() => ask('set', {name: setting.name, value: field.value}))
            .then(() => { $('status').textContent = `${setting.name} = ${field.value}`; }, error => { $('status').textContent = error.message; });
        label.append(field, setting.unit);
        $('settings').append(label);
    }
}
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
    model = upload(positions, normals);
    $('scene').textContent += `, ${model.count / 3} triangles`;
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
    gl.attachShader(program, shader(gl.VERTEX_SHADER, `attribute vec3 p, n; uniform mat4 clipFromWorld; uniform vec3 offset, scale; varying vec3 normal;
        void main() { normal = n; gl_Position = clipFromWorld * vec4(p * scale + offset, 1.0); }`));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `precision mediump float; uniform vec3 color; varying vec3 normal;
        void main() { float l = 0.35 + 0.65 * abs(dot(normalize(normal), normalize(vec3(0.4, 0.8, 0.5)))); gl_FragColor = vec4(color * l, 1.0); }`));
    gl.linkProgram(program);
    const corners = [], rows = 12;
    const at = (i, k) => { const a = Math.PI * i / rows, b = Math.PI * k / rows; return [Math.sin(a) * Math.cos(b), Math.cos(a), Math.sin(a) * Math.sin(b)]; };
    for (let i = 0; i < rows; ++i) for (let k = 0; k < 2 * rows; ++k)
        corners.push(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k), at(i + 1, k + 1), at(i, k + 1));
    ball = upload(corners.flat(), corners.flat());
}
function draw(shape, color, offset = [0, 0, 0], scale = [1, 1, 1]) {
    const set = (name, buffer) => { const a = gl.getAttribLocation(program, name); gl.bindBuffer(gl.ARRAY_BUFFER, buffer); gl.enableVertexAttribArray(a); gl.vertexAttribPointer(a, 3, gl.FLOAT, false, 0, 0); };
    set('p', shape.positions); set('n', shape.normals);
    gl.uniform3fv(gl.getUniformLocation(program, 'color'), color);
    gl.uniform3fv(gl.getUniformLocation(program, 'offset'), offset);
    gl.uniform3fv(gl.getUniformLocation(program, 'scale'), scale);
    gl.drawArrays(gl.TRIANGLES, 0, shape.count);
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
    if (model) draw(model, [0.55, 0.68, 0.75]);
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
