// The few modules of vtk.js that the page needs: its profiles would bring WebGPU and more, at three times the size.

import "@kitware/vtk.js/Rendering/OpenGL/Actor";
import "@kitware/vtk.js/Rendering/OpenGL/Camera";
import "@kitware/vtk.js/Rendering/OpenGL/PolyDataMapper";
import "@kitware/vtk.js/Rendering/OpenGL/Renderer";
import "@kitware/vtk.js/Rendering/OpenGL/SphereMapper";

export { default as vtkDataArray } from "@kitware/vtk.js/Common/Core/DataArray";
export { default as vtkPoints } from "@kitware/vtk.js/Common/Core/Points";
export { default as vtkPolyData } from "@kitware/vtk.js/Common/DataModel/PolyData";
export { default as vtkActor } from "@kitware/vtk.js/Rendering/Core/Actor";
export { default as vtkMapper } from "@kitware/vtk.js/Rendering/Core/Mapper";
export { default as vtkRenderWindow } from "@kitware/vtk.js/Rendering/Core/RenderWindow";
export { default as vtkRenderer } from "@kitware/vtk.js/Rendering/Core/Renderer";
export { default as vtkSphereMapper } from "@kitware/vtk.js/Rendering/Core/SphereMapper";
export { default as vtkOpenGLRenderWindow } from "@kitware/vtk.js/Rendering/OpenGL/RenderWindow";

/** Whether the browser can draw the field view. */
export function hasWebGL2(): boolean {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    // A browser allows a page some sixteen contexts: this one is given back.
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}
