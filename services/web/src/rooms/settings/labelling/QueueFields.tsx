import { Checkbox } from "../../../components";
import type { CollectionSettings } from "./defaults";
import styles from "./fields.module.css";
import { NumberSetting } from "./NumberSetting";

export interface FieldsProps {
  settings: CollectionSettings;
  onChange: (part: Partial<CollectionSettings>) => void;
}

export function QueueFields({ settings, onChange }: FieldsProps) {
  return (
    <div className={styles.fields}>
      <NumberSetting
        label="Labels per shape"
        hint="How many people label each shape, without seeing each other’s labels. One is usual; more tell how sure the labels are."
        min={1}
        max={9}
        value={settings.labels_per_shape}
        onChange={(labels_per_shape) => onChange({ labels_per_shape })}
      />
      <NumberSetting
        label="Agreement"
        hint={
          settings.labels_per_shape === 1
            ? "Only where several people label a shape."
            : "The share of the area on which their labels must agree. Below it, a reviewer decides."
        }
        unit="%"
        min={0}
        max={100}
        isDisabled={settings.labels_per_shape === 1}
        value={Math.round(settings.agreement * 100)}
        onChange={(percent) => onChange({ agreement: percent / 100 })}
      />
      <NumberSetting
        label="Blind checks"
        hint="Of the shapes handed out, how many have labels that are known already. Nobody can tell which; they show how exact each person is."
        unit="%"
        min={0}
        max={100}
        value={Math.round(settings.honeypot_share * 100)}
        onChange={(percent) => onChange({ honeypot_share: percent / 100 })}
      />
      <NumberSetting
        label="Train after"
        hint="A training begins by itself once this many shapes more are confirmed. 0: only when somebody asks for one."
        min={0}
        max={1_000_000}
        value={settings.train_after}
        onChange={(train_after) => onChange({ train_after })}
      />
      <Checkbox
        className={styles.whole ?? ""}
        label="Review before training"
        hint="A reviewer looks at all confirmed labels before a model learns from them."
        isChecked={settings.review}
        onChange={(review) => onChange({ review })}
      />
    </div>
  );
}
