(** Random radii: mean and variance of linear forms that are listed layer by layer. Laws exist, too: a coin for
    each bead. *)

From Coq Require Import ZArith Reals Lia Lra Bool List FunctionalExtensionality.
From ForceDiffusion Require Import Model Sums.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Lemma Sum_pick low high a (x : R) : (low <= a <= high)%Z ->
  Sum low high (fun m => if (a =? m)%Z then x else 0) = x.
Proof.
  intros H. rewrite (Sum_split low a high) by lia. rewrite (Sum_last low a), Z.eqb_refl by lia.
  rewrite (Sum_zero low (a - 1)), (Sum_zero (a + 1) high); [ring| |];
    intros m Hm; replace (a =? m)%Z with false by lia; reflexivity.
Qed.

(** ** Linear forms, layer by layer *)

(** Weights and the places of the radii that they weigh, in one layer. *)
Definition layer := list (R * Z).

Fixpoint weigh (l : layer) (m : Z) (rho : radii) : R :=
  match l with
  | nil => 0
  | (w, a) :: rest => w * rho a m + weigh rest m rho
  end.

(** The sum of products of weights that stand on one radius. *)
Fixpoint on_one_radius (w : R) (a : Z) (l : layer) : R :=
  match l with
  | nil => 0
  | (v, b) :: rest => (if (a =? b)%Z then w * v else 0) + on_one_radius w a rest
  end.
Fixpoint overlap (l k : layer) : R :=
  match l with
  | nil => 0
  | (w, a) :: rest => on_one_radius w a k + overlap rest k
  end.

Section Moments.
  Context (W M : Z) (sigma : R) (L : law W M sigma).

  Definition inside (l : layer) (m : Z) : Prop := Forall (fun one => within W M (snd one) m) l.

  (** f has the expectation v. *)
  Definition known (f : radii -> R) (v : R) : Prop := integrable L f /\ expect L f = v.

  Lemma known_as f g v : known f v -> (forall rho, f rho = g rho) -> known g v.
  Proof. intros H E. replace g with f by (apply functional_extensionality, E). exact H. Qed.

  Lemma known_sum f g v w : known f v -> known g w -> known (fun rho => f rho + g rho) (v + w).
  Proof.
    intros [If <-] [Ig <-]. split; [apply integrable_sum; assumption|apply expect_sum; assumption].
  Qed.

  Lemma known_multiple c f v : known f v -> known (fun rho => c * f rho) (c * v).
  Proof.
    intros [If <-]. split; [apply integrable_multiple; exact If|apply expect_multiple; exact If].
  Qed.

  Lemma known_constant c : known (fun _ => c) c.
  Proof. split; [apply integrable_constant|apply expect_constant]. Qed.

  Lemma known_Sum low high (f : Z -> radii -> R) v :
    (forall m, (low <= m <= high)%Z -> known (f m) (v m)) ->
    known (fun rho => Sum low high (fun m => f m rho)) (Sum low high v).
  Proof.
    pattern high. apply (Sum_induction low).
    - intros n Hn _. rewrite Sum_empty by lia.
      apply (known_as (fun _ => 0)); [apply known_constant|]. intros. rewrite Sum_empty by lia. auto.
    - intros n Hn IH H. rewrite Sum_last by lia.
      apply (known_as (fun rho => Sum low (n - 1) (fun m => f m rho) + f n rho));
        [apply known_sum; [apply IH; intros; apply H; lia|apply H; lia]|].
      intros rho. rewrite (Sum_last low n) by lia. reflexivity.
  Qed.

  Lemma known_weigh l m : inside l m -> known (weigh l m) 0.
  Proof.
    induction l as [|[w a] l IH]; intros H; cbn [weigh].
    - apply known_constant.
    - inversion H as [|x y Ha Hl]; subst. replace 0 with (w * 0 + 0) by ring.
      apply known_sum; [apply known_multiple|apply IH; exact Hl].
      split; [apply radii_integrable; exact Ha|apply mean_radius; exact Ha].
  Qed.

  Lemma known_on_one_radius w a l m n : within W M a m -> inside l n ->
    known (fun rho => w * rho a m * weigh l n rho) (if (m =? n)%Z then sigma ^ 2 * on_one_radius w a l else 0).
  Proof.
    intros Ha. induction l as [|[v b] l IH]; intros H; cbn [weigh on_one_radius].
    - apply (known_as (fun _ => 0)); [|intros; ring].
      destruct (m =? n)%Z; [rewrite Rmult_0_r|]; apply known_constant.
    - inversion H as [|x y Hb Hl]; subst. cbn [snd] in Hb.
      pose proof (products_integrable _ _ _ L a m b n Ha Hb) as I.
      pose proof (second_moments _ _ _ L a m b n Ha Hb) as E.
      specialize (IH Hl).
      pose proof (known_sum _ _ _ _ (known_multiple (w * v) _ _ (conj I E)) IH) as K.
      apply (known_as _ (fun rho => w * rho a m * (v * rho b n + weigh l n rho))) in K;
        [|intros; ring].
      replace (if (m =? n)%Z then sigma ^ 2 * ((if (a =? b)%Z then w * v else 0) + on_one_radius w a l) else 0)
        with (w * v * (if ((a =? b) && (m =? n))%bool%Z then sigma ^ 2 else 0)
              + (if (m =? n)%Z then sigma ^ 2 * on_one_radius w a l else 0)); [exact K|].
      destruct (a =? b)%Z, (m =? n)%Z; cbn [andb]; ring.
  Qed.

  Lemma known_overlap l k m n : inside l m -> inside k n ->
    known (fun rho => weigh l m rho * weigh k n rho)
      (if (m =? n)%Z then sigma ^ 2 * overlap l k else 0).
  Proof.
    induction l as [|[w a] l IH]; intros H K; cbn [weigh overlap].
    - apply (known_as (fun _ => 0)); [|intros; ring].
      destruct (m =? n)%Z; [rewrite Rmult_0_r|]; apply known_constant.
    - inversion H as [|x y Ha Hl]; subst. cbn [snd] in Ha.
      pose proof (known_sum _ _ _ _ (known_on_one_radius w a k m n Ha K) (IH Hl K)) as E.
      apply (known_as _ (fun rho => (w * rho a m + weigh l m rho) * weigh k n rho)) in E;
        [|intros; ring].
      replace (if (m =? n)%Z then sigma ^ 2 * (on_one_radius w a k + overlap l k) else 0)
        with ((if (m =? n)%Z then sigma ^ 2 * on_one_radius w a k else 0)
              + (if (m =? n)%Z then sigma ^ 2 * overlap l k else 0)); [exact E|].
      destruct (m =? n)%Z; ring.
  Qed.

  (** A linear form whose weights are listed layer by layer. *)
  Definition whole (form : Z -> layer) (rho : radii) : R := Sum 0 M (fun m => weigh (form m) m rho).
  Definition squares (form : Z -> layer) : R := Sum 0 M (fun m => overlap (form m) (form m)).

  Variable form : Z -> layer.
  Hypothesis form_inside : forall m, (0 <= m <= M)%Z -> inside (form m) m.

  Lemma whole_mean : known (whole form) 0.
  Proof.
    replace 0 with (Sum 0 M (fun _ => 0)) by (apply Sum_zero; auto).
    apply (known_Sum 0 M (fun m => weigh (form m) m)). intros. apply known_weigh, form_inside. lia.
  Qed.

  Lemma whole_square : known (fun rho => whole form rho * whole form rho) (sigma ^ 2 * squares form).
  Proof.
    apply (known_as (fun rho => Sum 0 M (fun m => Sum 0 M (fun n =>
      weigh (form m) m rho * weigh (form n) n rho)))).
    - unfold squares. rewrite <- Sum_scale.
      apply (known_Sum 0 M (fun m rho => Sum 0 M (fun n => weigh (form m) m rho * weigh (form n) n rho))).
      intros m Hm.
      replace (sigma ^ 2 * overlap (form m) (form m)) with
        (Sum 0 M (fun n => if (m =? n)%Z then sigma ^ 2 * overlap (form m) (form n) else 0)).
      + apply (known_Sum 0 M (fun n rho => weigh (form m) m rho * weigh (form n) n rho)).
        intros n Hn. apply known_overlap; apply form_inside; lia.
      + rewrite <- (Sum_pick 0 M m (sigma ^ 2 * overlap (form m) (form m))) by lia.
        apply Sum_eq; auto. intros n Hn. destruct (Z.eqb_spec m n) as [->|]; reflexivity.
    - intros rho. unfold whole. rewrite <- Sum_times. apply Sum_eq; auto. intros m Hm. apply Sum_scale.
  Qed.

  (** Mean and variance of a constant plus a multiple of the form. *)
  Theorem form_variance c w f : (forall rho, f rho = c + w * whole form rho) ->
    expect L f = c /\ variance L f = w ^ 2 * (sigma ^ 2 * squares form).
  Proof.
    intros E. assert (D : expect L f = c).
    { pose proof (known_sum _ _ _ _ (known_constant c) (known_multiple w _ _ whole_mean)) as K.
      apply (known_as _ f) in K; [|intros; symmetry; apply E]. destruct K as [_ ->]. ring. }
    split; [exact D|]. unfold variance. rewrite D.
    pose proof (known_multiple (w ^ 2) _ _ whole_square) as K.
    apply (known_as _ (fun rho => (f rho - c) ^ 2)) in K; [exact (proj2 K)|].
    intros rho. rewrite E. ring.
  Qed.
End Moments.

(** ** Laws exist: every bead of a window tosses a coin for +σ or −σ *)

Definition put (rho : radii) (a : Z * Z) (x : R) : radii :=
  fun i j => if ((i =? fst a) && (j =? snd a))%bool%Z then x else rho i j.

(** The mean over all tosses. *)
Fixpoint coins (sigma : R) (sites : list (Z * Z)) (f : radii -> R) (rho : radii) : R :=
  match sites with
  | nil => f rho
  | a :: rest => (coins sigma rest f (put rho a sigma) + coins sigma rest f (put rho a (- sigma))) / 2
  end.

Lemma coins_sum sigma sites f g : forall rho,
  coins sigma sites (fun x => f x + g x) rho = coins sigma sites f rho + coins sigma sites g rho.
Proof. induction sites as [|a rest IH]; intros rho; cbn [coins]; [reflexivity|]. rewrite !IH. field. Qed.

Lemma coins_multiple sigma sites c f : forall rho,
  coins sigma sites (fun x => c * f x) rho = c * coins sigma sites f rho.
Proof. induction sites as [|a rest IH]; intros rho; cbn [coins]; [reflexivity|]. rewrite !IH. field. Qed.

Lemma coins_constant sigma sites c : forall rho, coins sigma sites (fun _ => c) rho = c.
Proof. induction sites as [|a rest IH]; intros rho; cbn [coins]; [reflexivity|]. rewrite !IH. field. Qed.

Lemma coins_ignore sigma sites (f : radii -> R) : (forall a rho x, In a sites -> f (put rho a x) = f rho) ->
  forall rho, coins sigma sites f rho = f rho.
Proof.
  induction sites as [|a rest IH]; intros H rho; cbn [coins]; [reflexivity|].
  rewrite !IH by (intros; apply H; right; assumption). rewrite !H by (left; reflexivity). field.
Qed.

Lemma put_same rho i j x : put rho (i, j) x i j = x.
Proof. unfold put. cbn [fst snd]. rewrite !Z.eqb_refl. reflexivity. Qed.

Lemma put_other rho a i j x : (i, j) <> a -> put rho a x i j = rho i j.
Proof.
  intros H. unfold put. destruct a as [k l]. cbn [fst snd].
  destruct (Z.eqb_spec i k) as [->|]; [destruct (Z.eqb_spec j l) as [->|]|]; cbn [andb]; auto.
  contradiction.
Qed.

Lemma coins_mean sigma sites i j : NoDup sites -> forall rho, In (i, j) sites ->
  coins sigma sites (fun x => x i j) rho = 0.
Proof.
  induction sites as [|a rest IH]; intros D rho H; [destruct H|].
  inversion D as [|x y Ha Hr]; subst. cbn [coins]. destruct H as [->|H].
  - rewrite !coins_ignore, !put_same; [field|
      intros b s x Hb; apply put_other; intros E; subst; contradiction..].
  - rewrite !IH by assumption. field.
Qed.

(** What is not tossed comes out of the mean. *)
Lemma coins_factor sigma sites (f : radii -> R) i j : ~ In (i, j) sites -> forall rho,
  coins sigma sites (fun x => x i j * f x) rho = rho i j * coins sigma sites f rho.
Proof.
  induction sites as [|a rest IH]; intros H rho; cbn [coins]; [reflexivity|].
  rewrite !IH by (intros E; apply H; right; exact E).
  rewrite !put_other by (intros E; apply H; left; symmetry; exact E). field.
Qed.

Lemma coins_as sigma sites f g : (forall x, f x = g x) -> forall rho,
  coins sigma sites f rho = coins sigma sites g rho.
Proof. intros E. induction sites as [|a rest IH]; intros rho; cbn [coins]; [apply E|rewrite !IH; reflexivity]. Qed.

Lemma coins_product sigma sites i j k l : NoDup sites -> forall rho,
  In (i, j) sites -> In (k, l) sites ->
  coins sigma sites (fun x => x i j * x k l) rho =
    if ((i =? k) && (j =? l))%bool%Z then sigma ^ 2 else 0.
Proof.
  assert (Apart : forall i j k l (rest : list (Z * Z)), ~ In (i, j) rest -> In (k, l) rest ->
    ((i =? k) && (j =? l))%bool%Z = false).
  { intros a b c d rest A B. destruct (Z.eqb_spec a c) as [->|]; [destruct (Z.eqb_spec b d) as [->|]|]; auto.
    contradiction. }
  induction sites as [|a rest IH]; intros D rho H K; [destruct H|].
  inversion D as [|x y Ha Hr]; subst. cbn [coins]. destruct H as [->|H], K as [E|K].
  - injection E as -> ->. rewrite !Z.eqb_refl, !coins_factor by exact Ha. cbn [andb].
    rewrite !coins_ignore, !put_same; [field|
      intros b s x Hb; apply put_other; intros E; subst; contradiction..].
  - rewrite (Apart _ _ _ _ rest Ha K), !coins_factor, !coins_mean by assumption. field.
  - subst a. rewrite (Z.eqb_sym i), (Z.eqb_sym j), (Apart _ _ _ _ rest Ha H).
    assert (S : forall t, coins sigma rest (fun x => x i j * x k l) t = coins sigma rest (fun x => x k l * x i j) t)
      by (apply coins_as; intros; apply Rmult_comm).
    rewrite !S, !coins_factor, !coins_mean by assumption. field.
  - rewrite !IH by assumption. field.
Qed.

Definition all_within (W M : Z) : list (Z * Z) :=
  list_prod (map (fun n => Z.of_nat n - W)%Z (seq 0 (Z.to_nat (2 * W + 1))))
            (map Z.of_nat (seq 0 (Z.to_nat (M + 1)))).

Lemma all_within_holds W M i j : within W M i j -> In (i, j) (all_within W M).
Proof.
  unfold within, bead. intros H. apply in_prod_iff. split; apply in_map_iff.
  - exists (Z.to_nat (i + W)). split; [lia|]. apply in_seq. lia.
  - exists (Z.to_nat j). split; [lia|]. apply in_seq. lia.
Qed.

Definition same_site (a b : Z * Z) : {a = b} + {a <> b}.
Proof. decide equality; apply Z.eq_dec. Defined.

Theorem law_exists W M sigma : exists _ : law W M sigma, True.
Proof.
  set (sites := nodup same_site (all_within W M)).
  assert (D : NoDup sites) by apply NoDup_nodup.
  assert (S : forall i j, within W M i j -> In (i, j) sites)
    by (intros; apply nodup_In, all_within_holds; assumption).
  unshelve eexists; [|exact I].
  refine {| integrable := fun _ => True; expect := fun f => coins sigma sites f (fun _ _ => 0) |};
    intros; try exact I.
  - apply coins_constant.
  - apply coins_sum.
  - apply coins_multiple.
  - apply coins_mean; auto.
  - apply coins_product; auto.
Qed.
