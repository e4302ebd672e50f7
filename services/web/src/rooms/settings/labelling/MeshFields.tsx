import { Segmented, Select } from "../../../components";
import styles from "./fields.module.css";
import { NumberSetting } from "./NumberSetting";
import type { FieldsProps } from "./QueueFields";

export function MeshFields({ settings, onChange }: FieldsProps) {
  return (
    <div className={styles.fields}>
      <NumberSetting
        label="Faces of working meshes"
        hint="How fine the surfaces are that people label, where they are remeshed. 10,000 are usual; more are slower and follow small parts better."
        min={100}
        max={1_000_000}
        value={settings.working_faces}
        onChange={(working_faces) => onChange({ working_faces })}
      />
      <Select
        label="Remeshing"
        hint="Meshes with holes, loose pieces or very many faces get a closed surface to work on. Labels are mapped back to the file’s own faces on export."
        value={settings.remesh}
        options={[
          { value: "auto", label: "Where a mesh needs it" },
          { value: "never", label: "Never" },
        ]}
        onChange={(remesh) => onChange({ remesh })}
      />
      <div className={styles.up}>
        <span className={styles.label} aria-hidden="true">
          Up
        </span>
        <div>
          <Segmented
            label="Axis that points up"
            value={settings.up}
            options={[
              { value: "x", label: "X" },
              { value: "y", label: "Y" },
              { value: "z", label: "Z" },
            ]}
            onChange={(up) => onChange({ up })}
          />
        </div>
        <p className={styles.hint}>The axis that points up in pictures and on the workbench.</p>
      </div>
    </div>
  );
}
