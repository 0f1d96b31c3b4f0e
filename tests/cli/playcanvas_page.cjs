// Shows a glTF file of Gaussians in a page of PlayCanvas in Chromium. In: Chromium, a folder node_modules, the
// model, the picture to write, and size, view and camera as JSON. Out: the picture, or a line that says why not.
const fs = require("fs"), http = require("http"), path = require("path");
const [chromium, modules, model, picture, camera] = process.argv.slice(2);
const { width, height, fov, position, target } = JSON.parse(camera);
const page = `<!doctype html><canvas id="canvas"></canvas><script type="module">
import * as pc from "/playcanvas.mjs";
try {
    const canvas = document.getElementById("canvas");
    const device = await pc.createGraphicsDevice(canvas, { deviceTypes: ["webgl2"], antialias: false });
    device.maxPixelRatio = 1;
    const options = new pc.AppOptions();
    options.graphicsDevice = device;
    options.componentSystems = [pc.CameraComponentSystem, pc.RenderComponentSystem, pc.GSplatComponentSystem];
    options.resourceHandlers = [pc.ContainerHandler, pc.GSplatHandler, pc.TextureHandler];
    const app = new pc.AppBase(canvas);
    app.init(options);
    app.setCanvasFillMode(pc.FILLMODE_NONE, ${width}, ${height});
    app.setCanvasResolution(pc.RESOLUTION_FIXED, ${width}, ${height});
    const asset = new pc.Asset("model", "container", { url: "/model.glb" });
    await new Promise((loaded, failed) => {
        asset.once("load", loaded);
        asset.once("error", failed);
        app.assets.add(asset);
        app.assets.load(asset);
    });
    const eye = new pc.Entity();
    eye.addComponent("camera", { clearColor: new pc.Color(0, 0, 0, 1), fov: ${fov}, nearClip: 0.1, farClip: 100 });
    app.root.addChild(eye);
    eye.setPosition(...${JSON.stringify(position)});
    eye.lookAt(...${JSON.stringify(target)});
    app.root.addChild(asset.resource.instantiateRenderEntity());
    app.start();
    let frames = 0;  // splats are sorted alongside the frames
    app.on("frameend", () => {
        if (++frames === 120)
            canvas.toBlob((blob) => fetch("/picture", { method: "POST", body: blob }));
    });
} catch (error) {
    fetch("/failed", { method: "POST", body: String(error && error.stack || error) });
}
</script>`;
const end = (code, message) => {
    if (message) console.log(message);
    browser.kill("SIGKILL");
    process.exit(code);
};
const server = http.createServer((request, response) => {
    const chunks = [];
    request.on("data", (chunk) => chunks.push(chunk));
    request.on("end", () => {
        const body = Buffer.concat(chunks), send = (type, data) => {
            response.writeHead(200, { "Content-Type": type });
            response.end(data);
        };
        if (request.url === "/") send("text/html", page);
        else if (request.url === "/playcanvas.mjs") send("text/javascript", fs.readFileSync(path.join(modules, "playcanvas/build/playcanvas.mjs")));
        else if (request.url === "/model.glb") send("model/gltf-binary", fs.readFileSync(model));
        else if (request.url === "/picture") { fs.writeFileSync(picture, body); send("text/plain", ""); end(0); }
        else if (request.url === "/failed") end(1, body.toString());
        else { response.writeHead(404); response.end(); }
    });
});
let browser;
server.listen(0, "127.0.0.1", () => {
    browser = require("child_process").spawn(chromium, ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
        "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--user-data-dir=" + path.resolve("profile"),
        "http://127.0.0.1:" + server.address().port + "/"], { stdio: "ignore" });
    setTimeout(() => end(1, "no picture after two minutes"), 120000);
});
